// The page of `render --preview` and `etalon view`: asks what there is, and shows it. No library, no other host.
const $ = (id) => document.getElementById(id);
const canvas = $('canvas'), context = canvas.getContext('2d');

// ---- What there is.
let state = { pictures: [] };
const loaded = [null, null]; // Numbers of each file, with the version and layer that they are of.
let which = 0, column = -1, row = -1, over = false;

const wanted = () => (mode() === 'difference' || mode() === 'deviation' ? [0, 1] : [which]).filter((i) => state.pictures[i]);
const mode = () => $('mode').value || 'picture';

async function load(index) {
  const about = state.pictures[index];
  const layer = Math.max(0, about.layers.indexOf($('layer').value));
  const have = loaded[index];
  if (have && have.version >= about.version && have.layer === layer) return false;
  const answer = await fetch(`picture/${index}/${layer}`);
  if (!answer.ok) return false;
  const [width, height] = answer.headers.get('X-Size').split('x').map(Number);
  const values = new Float32Array(await answer.arrayBuffer());
  const pixels = width * height;
  const plane = (n) => values.subarray(n * pixels, (n + 1) * pixels);
  loaded[index] = {
    width, height, pixels, layer, version: Number(answer.headers.get('X-Version')),
    planes: [0, 1, 2].map(plane), errors: values.length >= 6 * pixels ? [3, 4, 5].map(plane) : null,
  };
  return true;
}

// ---- How numbers become colours.
const WEIGHTS = [0.2126, 0.7152, 0.0722]; // Of luminance, ITU-R BT.709.
const STEEPNESS = (0.18 - 0.18 * 0.18 / 256) / 0.82 / 0.18, WHITE = 16 * STEEPNESS;
const filmic = (x) => { const a = STEEPNESS * x; return a * (1 + a / (WHITE * WHITE)) / (1 + a); };
// One code for each of the 2^17 values that the upper bits of a float can have: eight bits of mantissa.
const codes = new Uint8ClampedArray(1 << 17);
let coded = '';
function code() {
  const stops = Number($('exposure').value), view = $('view').value, key = `${stops} ${view}`;
  if (key === coded) return;
  coded = key;
  const bits = new Uint32Array(1), number = new Float32Array(bits.buffer), gain = 2 ** stops;
  for (let i = 0; i < codes.length; i++) {
    bits[0] = (i << 15) | 0x4000;
    const x = number[0] * gain;
    codes[i] = x > 0 ? 255 * encoded(view === 'filmic' ? filmic(Math.min(x, 1e30)) : x) : 0;
  }
}
const SEQUENTIAL = ramp(['#0b0d12', '#2c1a5c', '#8a2267', '#dd4a49', '#fb9f3a', '#fcf3a8']);
const luminance = ({ planes }, i) => WEIGHTS[0] * planes[0][i] + WEIGHTS[1] * planes[1][i] + WEIGHTS[2] * planes[2][i];
const deviation = ({ errors }, i) => Math.hypot(...[0, 1, 2].map((c) => WEIGHTS[c] * errors[c][i]));
// Keeps relative numbers finite where a picture is black: 5 % of its mean.
const floor = (source) => {
  const step = Math.ceil(source.pixels / 1e5);
  let sum = 0, count = 0;
  for (let i = 0; i < source.pixels; i += step) { const x = luminance(source, i); if (Number.isFinite(x)) { sum += Math.abs(x); count += 1; } }
  return 0.05 * sum / Math.max(count, 1) || 1;
};
const SCALES = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100];
// The least scale that 95 % of the pixels stay within.
const suitable = (values) => {
  const step = Math.ceil(values.length / 1e5), sizes = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) sizes.push(Math.abs(values[i]));
  sizes.sort((a, b) => a - b);
  const most = sizes[Math.floor(0.95 * (sizes.length - 1))] || 0;
  return SCALES.find((x) => x >= most) || SCALES[SCALES.length - 1];
};

// ---- The picture as pixels of its own size.
const picture = document.createElement('canvas');
function develop() {
  const [a, b] = [loaded[mode() === 'difference' || mode() === 'deviation' ? 0 : which], loaded[1]];
  if (!a) return;
  if (picture.width !== a.width || picture.height !== a.height) [picture.width, picture.height] = [a.width, a.height];
  const brush = picture.getContext('2d'), image = brush.createImageData(a.width, a.height);
  const out = new Uint32Array(image.data.buffer);
  $('legend').hidden = true;
  const map = (values, colours, signed, percent, about) => {
    const full = suitable(values);
    for (let i = 0; i < out.length; i++) out[i] = along(colours, signed ? (values[i] / full + 1) / 2 : values[i] / full);
    const name = percent ? `${Number((100 * full).toPrecision(2))} %` : `${full}`;
    $('legend').hidden = false;
    $('ramp').className = `ramp ${signed ? 'difference' : 'error'}`;
    [$('low').textContent, $('high').textContent, $('about').textContent] = [signed ? `−${name}` : '0', signed ? `+${name}` : name, about];
  };
  if (mode() === 'error' && a.errors) {
    const least = floor(a);
    const values = Float32Array.from(out, (_, i) => deviation(a, i) / (Math.abs(luminance(a, i)) + least));
    map(values, SEQUENTIAL, false, true, 'Standard error of the luminance, relative to it plus 5 % of its mean');
  } else if (mode() === 'difference' && b && b.pixels === a.pixels) {
    const least = floor(b);
    const values = Float32Array.from(out, (_, i) => (luminance(a, i) - luminance(b, i)) / (Math.abs(luminance(b, i)) + least));
    map(values, DIVERGING, true, true, 'Luminance: (first − second) / (second + 5 % of its mean). Blue: darker, orange: brighter');
  } else if (mode() === 'deviation' && b && b.pixels === a.pixels && (a.errors || b.errors)) {
    const error = (source, i) => (source.errors ? deviation(source, i) : 0);
    const values = Float32Array.from(out, (_, i) => {
      const s = Math.hypot(error(a, i), error(b, i));
      return s > 0 ? (luminance(a, i) - luminance(b, i)) / s : 0;
    });
    map(values, DIVERGING, true, false, 'Luminance: (first − second) / its standard error. Blue: darker, orange: brighter');
  } else {
    code();
    const [r, g, b] = a.planes.map((plane) => new Uint32Array(plane.buffer, plane.byteOffset, plane.length));
    const infinite = (bits) => (bits & 0x7f800000) === 0x7f800000;
    for (let i = 0; i < out.length; i++) {
      out[i] = infinite(r[i]) || infinite(g[i]) || infinite(b[i]) ? MAGENTA : opaque(codes[r[i] >>> 15], codes[g[i] >>> 15], codes[b[i] >>> 15]);
    }
  }
  brush.putImageData(image, 0, 0);
  draw();
}

// ---- Where it is on the screen: `zoom` screen pixels for one of its own, its corner at (left, top).
let zoom = 0, left = 0, top_ = 0, fitted = true;
function fit() {
  const { clientWidth: w, clientHeight: h } = canvas;
  const ratio = window.devicePixelRatio || 1;
  zoom = Math.min(w * ratio / picture.width, h * ratio / picture.height);
  if (zoom > 1) zoom = Math.floor(zoom);
  [left, top_, fitted] = [(w * ratio - zoom * picture.width) / 2, (h * ratio - zoom * picture.height) / 2, true];
}
function draw() {
  const ratio = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  $('empty').hidden = loaded.some(Boolean);
  if (!loaded.some(Boolean)) return;
  if (fitted) fit();
  context.clearRect(0, 0, w, h);
  context.imageSmoothingEnabled = zoom < 1;
  context.drawImage(picture, Math.round(left), Math.round(top_), Math.round(zoom * picture.width), Math.round(zoom * picture.height));
  if (over && zoom >= 4) {
    context.strokeStyle = '#79b8ff';
    context.strokeRect(Math.round(left + zoom * column) + 0.5, Math.round(top_ + zoom * row) + 0.5, Math.round(zoom), Math.round(zoom));
  }
  $('zoom').textContent = `${Math.round(100 * zoom)} %`;
}
function magnify(factor, x = canvas.width / 2, y = canvas.height / 2) {
  const next = clamp(zoom * factor, 1 / 32, 64);
  [left, top_] = [x - (x - left) * next / zoom, y - (y - top_) * next / zoom];
  [zoom, fitted] = [next, false];
  draw();
}

// ---- Reading a pixel.
function read() {
  if (!over) return;
  const told = state.pictures.map((about, index) => {
    const source = loaded[index];
    if (!source || column >= source.width || row >= source.height) return '';
    const i = row * source.width + column;
    const value = (c) => `${'RGB'[c]} ${shown(source.planes[c][i])}${source.errors ? ` ± ${source.errors[c][i].toPrecision(2)}` : ''}`;
    return `${state.pictures.length > 1 ? `${about.name}: ` : ''}${[0, 1, 2].map(value).join('  ')}`;
  });
  $('readout').textContent = `(${column}, ${row})  ${told.filter(Boolean).join('  ·  ')}`;
}
function point(x, y, live) {
  if (!picture.width || !loaded.some(Boolean)) return;
  const [c, r] = [Math.floor((x - left) / zoom), Math.floor((y - top_) / zoom)];
  if (c < 0 || r < 0 || c >= picture.width || r >= picture.height) return;
  [column, row, over] = [c, r, true];
  $('readout').setAttribute('aria-live', live);
  read();
  draw();
}
const at = (event) => {
  const box = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  return [(event.clientX - box.left) * ratio, (event.clientY - box.top) * ratio];
};
let grip = null;
canvas.addEventListener('pointerdown', (event) => {
  const [x, y] = at(event);
  grip = { x, y, left, top: top_ };
  canvas.setPointerCapture(event.pointerId);
  canvas.classList.add('moving');
});
canvas.addEventListener('pointermove', (event) => {
  const [x, y] = at(event);
  if (grip && Math.hypot(x - grip.x, y - grip.y) > 2) {
    [left, top_, fitted] = [grip.left + x - grip.x, grip.top + y - grip.y, false];
    draw();
  }
  point(x, y, 'off');
});
['pointerup', 'pointercancel'].forEach((name) => canvas.addEventListener(name, () => { grip = null; canvas.classList.remove('moving'); }));
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  magnify(2 ** (-event.deltaY / 300), ...at(event));
}, { passive: false });
canvas.addEventListener('keydown', (event) => {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!by || event.ctrlKey || event.altKey || event.metaKey) return;
  const step = event.shiftKey ? 10 : 1;
  const from = over ? [column, row] : [Math.floor(picture.width / 2), Math.floor(picture.height / 2)];
  const next = [clamp(from[0] + step * by[0], 0, picture.width - 1), clamp(from[1] + step * by[1], 0, picture.height - 1)];
  point(left + zoom * (next[0] + 0.5), top_ + zoom * (next[1] + 0.5), 'polite');
  event.preventDefault();
});
new ResizeObserver(draw).observe(canvas);

// ---- Tools.
const stops = (value) => {
  $('exposure').value = value;
  const x = Number($('exposure').value);
  $('stops').textContent = `${x < 0 ? '−' : '+'}${Math.abs(x)} EV`;
};
const again = async () => { await Promise.all(wanted().map(load)); choices(); develop(); read(); };
$('exposure').addEventListener('input', () => { stops($('exposure').value); develop(); });
['view', 'mode', 'layer'].forEach((id) => $(id).addEventListener('change', again));
$('which').addEventListener('change', () => { which = Number($('which').value); again(); });
$('fit').addEventListener('click', () => { fitted = true; draw(); });
$('one').addEventListener('click', () => magnify(1 / zoom));
$('in').addEventListener('click', () => magnify(2));
$('out').addEventListener('click', () => magnify(0.5));
addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest('select, input')) return;
  const acts = {
    e: () => { stops(Number($('exposure').value) + 0.5); develop(); },
    E: () => { stops(Number($('exposure').value) - 0.5); develop(); },
    0: () => $('fit').click(), 1: () => $('one').click(), '+': () => magnify(2), '=': () => magnify(2), '-': () => magnify(0.5),
    f: () => { if (state.pictures.length > 1) { which = 1 - which; $('which').value = which; again(); } },
  };
  const act = acts[event.key] || acts[event.key.toLowerCase()];
  if (act) { act(); event.preventDefault(); }
});
// Options of a choice, without losing what was chosen.
const offer = (select, options) => {
  if (options.map(([value]) => value).join('\n') === [...select.options].map((option) => option.value).join('\n')) return;
  const chosen = select.value;
  select.replaceChildren(...options.map(([value, name]) => new Option(name, value)));
  if (options.some(([value]) => String(value) === chosen)) select.value = chosen;
};
function choices() {
  const pair = state.pictures.length > 1;
  const modes = [['picture', 'picture']];
  if (loaded.some((source) => source && source.errors)) modes.push(['error', 'standard error']);
  if (pair) modes.push(['difference', 'difference']);
  if (pair && loaded.some((source) => source && source.errors)) modes.push(['deviation', 'difference in standard errors']);
  offer($('mode'), modes);
  offer($('which'), state.pictures.map((about, index) => [index, about.name]));
  ['which-label', 'flip-help'].forEach((id) => { $(id).hidden = !pair; });
  const layers = (state.pictures[which] || state.pictures[0] || { layers: [] }).layers;
  offer($('layer'), layers.map((name) => [name, name]));
}

// ---- Asking.
const time = (seconds) => {
  const s = Math.round(seconds);
  return s < 60 ? `${s} s` : s < 3600 ? `${Math.floor(s / 60)} min ${s % 60} s` : `${Math.floor(s / 3600)} h ${Math.floor(s / 60) % 60} min`;
};
function tell() {
  const { progress, finished, pictures } = state;
  $('title').textContent = state.title;
  document.title = `${progress && !finished ? `${Math.floor(100 * progress.done / progress.total)} % ` : ''}${state.title} – Etalon`;
  const about = pictures[which] || pictures[0];
  const words = [];
  if (progress) {
    $('progress').hidden = false;
    $('bar').value = finished ? 1 : progress.done / progress.total;
    if (progress.name) words.push(progress.name.trim());
    words.push(finished ? 'finished' : `${Math.floor(100 * progress.done / progress.total)} %`);
  }
  if (about && about.samples !== null) words.push(`${about.samples < 10 ? Number(about.samples.toPrecision(2)) : Math.round(about.samples)} samples per pixel`);
  if (progress && !finished) {
    words.push(`${(progress.rate / 1e6).toFixed(2)} M samples/s`);
    if (progress.left !== null) words.push(`${time(progress.left)} left`);
  }
  if (!progress && about && about.samples !== null) $('progress').hidden = false;
  $('bar').hidden = !progress;
  $('told').textContent = words.join(' · ');
}
let started = false, lost = 0;
async function ask() {
  let pause = 250;
  try {
    state = await (await fetch('state')).json();
    lost = 0;
    if (!started) {
      stops(state.exposure);
      $('view').value = state.view;
      started = true;
    }
    choices();
    tell();
    const indices = state.pictures.length > 1 ? [0, 1] : wanted();
    const changed = await Promise.all(indices.map(load));
    if (changed.some(Boolean)) { choices(); develop(); read(); }
    if (!state.progress) pause = 1000;
  } catch {
    lost += 1;
    pause = 1000;
    if (lost >= 2) {
      $('told').textContent = state.finished ? 'finished; the program has ended' : 'the program has ended';
      $('progress').hidden = false;
      if (state.finished) return;
    }
  }
  setTimeout(ask, pause);
}
ask();
