// How numbers become colours and words, in reports and in the preview.
'use strict';
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
// sRGB (IEC 61966-2-1).
const encoded = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(x, 1) ** (1 / 2.4) - 0.055);
const opaque = (r, g, b) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
const MAGENTA = opaque(255, 0, 255); // What is not finite.
const ramp = (stops) => stops.map((text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)));
// Blue, white, orange: the ramp of report.css.
const DIVERGING = ramp(['#0a2f6b', '#2f6fb5', '#93bfe6', '#f5f5f5', '#f2b582', '#cf6a1c', '#7c2f00']);
const along = (colours, share) => {
  if (Number.isNaN(share)) return MAGENTA;
  const at = clamp(share, 0, 1) * (colours.length - 1), low = Math.min(Math.floor(at), colours.length - 2), part = at - low;
  return opaque(...[0, 1, 2].map((c) => Math.round(colours[low][c] + part * (colours[low + 1][c] - colours[low][c]))));
};
const shown = (x) => (x === 0 || (Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5) ? x.toPrecision(4) : x.toExponential(2));
