// What a report does: its theme, its pictures, and the table of decisions. No library, no network.
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];

  // ---- Theme: as the system, light, dark.
  const theme = document.querySelector('.theme');
  if (theme) {
    const names = { '': 'as the system', light: 'light', dark: 'dark' };
    const order = Object.keys(names);
    const root = document.documentElement;
    const show = () => { theme.textContent = `Theme: ${names[root.dataset.theme || '']}`; };
    theme.addEventListener('click', () => {
      const next = order[(order.indexOf(root.dataset.theme || '') + 1) % order.length];
      if (next) root.dataset.theme = next; else delete root.dataset.theme;
      try { if (next) localStorage.setItem('etalon-theme', next); else localStorage.removeItem('etalon-theme'); }
      catch { /* a page without storage forgets */ }
      show();
    });
    show();
  }

  // ---- Pictures: planes of binary16, scaled by a power of two.
  const floats = (() => {
    const table = new Float32Array(65536);
    for (let bits = 0; bits < 65536; bits++) {
      const exponent = (bits >> 10) & 31, fraction = bits & 1023;
      const size = exponent === 31 ? (fraction ? NaN : Infinity)
        : exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction;
      table[bits] = bits & 32768 ? -size : size;
    }
    return table;
  })();
  const decoded = new Map();
  const picture = (name) => {
    if (!name) return null;
    if (!decoded.has(name)) {
      const { dataset, textContent } = document.getElementById(name);
      const text = atob(textContent.trim());
      const bits = new Uint16Array(text.length / 2);
      for (let i = 0; i < bits.length; i++) bits[i] = text.charCodeAt(2 * i) | (text.charCodeAt(2 * i + 1) << 8);
      const [width, height, planes, exponent] = [dataset.width, dataset.height, dataset.planes, dataset.exponent].map(Number);
      const pixels = width * height;
      decoded.set(name, {
        width, height, planes, exponent, bits, pixels,
        at: (pixel, plane = 0) => floats[bits[plane * pixels + pixel]] * 2 ** exponent,
      });
    }
    return decoded.get(name);
  };
  const raster = (width, height, paint) => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext('2d');
    const image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    paint(pixels);
    context.putImageData(image, 0, 0);
    return canvas;
  };

  // Linear numbers times 2^stops, as sRGB; every one of 65536 numbers is encoded once.
  const exposed = (source, stops) => {
    const gain = 2 ** (source.exponent + stops);
    const codes = new Uint8ClampedArray(65536);
    for (let bits = 0; bits < 65536; bits++) {
      const x = floats[bits] * gain;
      codes[bits] = x > 0 ? 255 * encoded(x) : 0;
    }
    const { bits, pixels } = source;
    return raster(source.width, source.height, (out) => {
      for (let i = 0; i < pixels; i++) {
        const [r, g, b] = [bits[i], bits[i + pixels], bits[i + 2 * pixels]];
        const finite = (r & 31744) !== 31744 && (g & 31744) !== 31744 && (b & 31744) !== 31744;
        out[i] = finite ? opaque(codes[r], codes[g], codes[b]) : MAGENTA;
      }
    });
  };
  const diverging = (x) => (Number.isFinite(x) ? along(DIVERGING, (x + 1) / 2) : MAGENTA);
  const mapped = (source, full) => raster(source.width, source.height, (out) => {
    for (let i = 0; i < source.pixels; i++) out[i] = diverging(source.at(i) / full);
  });

  const SCALES = {
    relative: [0.01, 0.03, 0.1, 0.3, 1].map((x) => [x, `${Math.round(100 * x)} %`]),
    deviation: [3, 5, 10, 30].map((x) => [x, `${x} s.e.`]),
  };
  // The least of the scales that 95 % of the pixels stay within.
  const suitable = (source, scales) => {
    // A hundred thousand pixels are enough to choose by.
    const step = Math.ceil(source.pixels / 1e5), sizes = new Float32Array(Math.ceil(source.pixels / step));
    for (let i = 0; i < sizes.length; i++) sizes[i] = Math.min(Math.abs(source.at(i * step)), 1e30);
    sizes.sort(); // What is no number goes to the end.
    const most = sizes[Math.floor(0.95 * (sizes.length - 1))] || 0;
    return (scales.find(([x]) => x >= most) || scales[scales.length - 1])[0];
  };
  const signed = (x, digits) => `${x < 0 ? '−' : '+'}${Math.abs(x).toFixed(digits)}`;

  const start = (viewer) => {
    if (viewer.dataset.started) return;
    viewer.dataset.started = 'yes';
    const find = (selector) => viewer.querySelector(selector);
    const [first, second] = [picture(viewer.dataset.first), picture(viewer.dataset.second)];
    const pair = find('canvas.pair'), map = find('canvas.map'), divider = find('.divider');
    const range = find('input[type=range]'), output = find('output'), readout = find('.readout');
    const choice = find('[data-do=map]'), scale = find('[data-do=scale]');
    const names = [find('.left').textContent, find('.right').textContent];
    const { width, height } = first;
    // Whole multiples of the pixels, so that the divider stands between screen pixels.
    const zoom = Math.max(1, Math.floor(640 / width));
    [pair.width, pair.height] = [width * zoom, height * zoom];
    let split = 50, pictures = [];

    const draw = () => {
      const context = pair.getContext('2d');
      context.imageSmoothingEnabled = false;
      const at = Math.round(pair.width * split / 100);
      [[pictures[0], 0, at], [pictures[1], at, pair.width]].forEach(([source, from, to]) => {
        if (to <= from) return;
        context.save();
        context.beginPath();
        context.rect(from, 0, to - from, pair.height);
        context.clip();
        context.drawImage(source, 0, 0, pair.width, pair.height);
        context.restore();
      });
    };
    const move = (to) => {
      split = clamp(Math.round(10 * to) / 10, 0, 100);
      divider.style.left = `${split}%`;
      divider.setAttribute('aria-valuenow', Math.round(split));
      divider.setAttribute('aria-valuetext', split <= 0 ? `${names[1]} alone` : split >= 100 ? `${names[0]} alone`
        : `${names[0]} left of ${Math.round(split)} %`);
      find('.left').style.visibility = split <= 0 ? 'hidden' : '';
      find('.right').style.visibility = split >= 100 ? 'hidden' : '';
      draw();
    };
    const flip = () => move(split >= 50 ? 0 : 100);
    const expose = (stops) => {
      range.value = stops;
      const value = Number(range.value);
      output.textContent = `${signed(value, 1)} EV`;
      pictures = [exposed(first, value), exposed(second, value)];
      draw();
    };
    const remap = () => {
      const source = picture(viewer.dataset[choice.value]);
      const full = Number(scale.value);
      const context = map.getContext('2d');
      [map.width, map.height] = [source.width, source.height];
      context.drawImage(mapped(source, full), 0, 0);
      const name = SCALES[choice.value].find(([x]) => x === full)[1];
      find('.low').textContent = `−${name}`;
      find('.high').textContent = `+${name}`;
      const about = find('.about');
      about.textContent = `${about.dataset[choice.value]}. Blue: darker than it ought to be; orange: brighter.`;
    };
    const rescale = () => {
      const scales = SCALES[choice.value];
      scale.replaceChildren(...scales.map(([x, name]) => new Option(`±${name}`, x)));
      scale.value = suitable(picture(viewer.dataset[choice.value]), scales);
      remap();
    };

    const drag = (event) => {
      const box = pair.getBoundingClientRect();
      move(100 * (event.clientX - box.left) / box.width);
    };
    [pair, divider].forEach((handle) => handle.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      const over = new AbortController(), { signal } = over;
      addEventListener('pointermove', drag, { signal });
      ['pointerup', 'pointercancel'].forEach((name) => addEventListener(name, () => over.abort(), { signal }));
      divider.focus({ preventScroll: true });
      if (handle === pair) drag(event);
      event.preventDefault();
    }));
    divider.addEventListener('keydown', (event) => {
      const step = event.shiftKey ? 10 : 1;
      const to = { ArrowLeft: split - step, ArrowDown: split - step, ArrowRight: split + step, ArrowUp: split + step,
        PageDown: split - 10, PageUp: split + 10, Home: 0, End: 100 }[event.key];
      if (to === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
      move(to);
      event.preventDefault();
    });
    viewer.addEventListener('keydown', (event) => {
      if (event.key.toLowerCase() !== 'f' || event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.target.closest('select')) return;
      flip();
      event.preventDefault();
    });
    const acts = { auto: () => expose(viewer.dataset.exposure), zero: () => expose(0), flip };
    all('button[data-do]', viewer).forEach((button) => button.addEventListener('click', acts[button.dataset.do]));
    range.addEventListener('input', () => expose(range.value));
    choice.addEventListener('change', rescale);
    scale.addEventListener('change', remap);
    // The pixel under the pointer, or that the arrow keys went to, in both panes.
    const cursors = all('.frame', viewer).map((frame) => {
      const cursor = document.createElement('span');
      cursor.className = 'cursor';
      Object.assign(cursor.style, { width: `${100 / width}%`, height: `${100 / height}%` });
      frame.append(cursor);
      return cursor;
    });
    let [column, row] = [Math.floor(width / 2), Math.floor(height / 2)];
    const read = (x, y, live) => {
      if (!(x >= 0 && y >= 0 && x < width && y < height)) return;
      [column, row] = [x, y];
      cursors.forEach((cursor) => Object.assign(cursor.style, { display: 'block', left: `${100 * x / width}%`, top: `${100 * y / height}%` }));
      readout.setAttribute('aria-live', live); // Told when asked for by keys, not along every way of a mouse.
      const pixel = y * width + x;
      const numbers = (source) => [0, 1, 2].map((plane) => shown(source.at(pixel, plane))).join('  ');
      const relative = picture(viewer.dataset.relative).at(pixel);
      const deviation = viewer.dataset.deviation ? `, ${signed(picture(viewer.dataset.deviation).at(pixel), 1)} standard errors` : '';
      readout.textContent = `(${x}, ${y})  ${names[0]}: ${numbers(first)} · ${names[1]}: ${numbers(second)} · ${signed(100 * relative, 2)} %${deviation}`;
    };
    [pair, map].forEach((canvas) => canvas.addEventListener('pointermove', (event) => {
      const box = canvas.getBoundingClientRect();
      read(Math.floor(width * (event.clientX - box.left) / box.width), Math.floor(height * (event.clientY - box.top) / box.height), 'off');
    }));
    map.addEventListener('keydown', (event) => {
      const step = event.shiftKey ? 10 : 1;
      const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
      if (!by || event.ctrlKey || event.altKey || event.metaKey) return;
      read(clamp(column + by[0], 0, width - 1), clamp(row + by[1], 0, height - 1), 'polite');
      event.preventDefault();
    });
    expose(viewer.dataset.exposure);
    rescale();
    move(50);
  };
  // Drawn when it comes into sight: what is folded away costs nothing.
  const sight = 'IntersectionObserver' in window ? new IntersectionObserver((entries) => {
    entries.filter((entry) => entry.isIntersecting).forEach((entry) => { sight.unobserve(entry.target); start(entry.target); });
  }, { rootMargin: '600px' }) : null;
  all('.viewer').forEach((viewer) => (sight ? sight.observe(viewer) : start(viewer)));
  addEventListener('beforeprint', () => all('.viewer').filter((viewer) => viewer.getClientRects().length).forEach(start));

  // ---- Many pictures with one exposure.
  const exposes = document.querySelector('.exposes');
  if (exposes) {
    const range = exposes.querySelector('input'), figures = all('figure[data-picture]');
    const expose = (stops) => {
      range.value = stops;
      exposes.querySelector('output').textContent = `${signed(Number(range.value), 1)} EV`;
      figures.forEach((figure) => {
        const still = figure.querySelector('img, canvas'), drawn = exposed(picture(figure.dataset.picture), Number(range.value));
        drawn.setAttribute('role', 'img');
        drawn.setAttribute('aria-label', figure.querySelector('figcaption').textContent);
        still.replaceWith(drawn);
      });
    };
    range.addEventListener('input', () => expose(range.value));
    exposes.querySelector('button').addEventListener('click', () => expose(0));
  }

  // ---- The table of decisions.
  const table = document.querySelector('table.decisions');
  if (!table) return;
  const rows = [...table.tBodies], heads = all('th', table.tHead), form = document.querySelector('.filters');
  const open = (row, wanted, draw = wanted) => {
    row.classList.toggle('open', wanted);
    row.querySelector('.toggle').setAttribute('aria-expanded', String(wanted));
    if (draw) all('.viewer', row).forEach(start);
  };
  rows.forEach((row) => {
    open(row, false);
    row.querySelector('.line').addEventListener('click', (event) => {
      // A link is a link, and text may be selected.
      if (event.target.closest('a') || String(getSelection())) return;
      open(row, !row.classList.contains('open'));
    });
  });
  const filter = () => {
    const chosen = new FormData(form);
    const outcomes = new Set(chosen.getAll('outcome')), kind = chosen.get('kind'), mutants = chosen.has('mutants');
    const words = chosen.get('text').toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    rows.forEach((row) => {
      const { outcome, mutant, search } = row.dataset;
      row.hidden = !(outcomes.has(outcome) && (kind === '' || kind === row.dataset.kind)
        && (mutants || mutant === 'no') && words.every((word) => search.includes(word)));
      count += !row.hidden;
    });
    form.querySelector('.count').textContent = `${count} of ${rows.length} rows shown`;
  };
  form.addEventListener('input', filter);
  form.addEventListener('submit', (event) => event.preventDefault());
  form.addEventListener('reset', () => setTimeout(filter));
  all('[data-open]').forEach((button) => button.addEventListener('click', () => {
    const wanted = button.dataset.open === 'yes';
    // What is in sight is drawn by itself.
    rows.filter((row) => !wanted || !row.hidden).forEach((row) => open(row, wanted, false));
  }));
  const value = (row, key) => row.querySelector(`.line > [data-key="${key}"]`).dataset.value ?? '';
  heads.forEach((head) => head.querySelector('button').addEventListener('click', () => {
    const descending = head.getAttribute('aria-sort') === 'ascending';
    heads.forEach((other) => other.removeAttribute('aria-sort'));
    head.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    const { key } = head.dataset;
    const numeric = head.dataset.numeric !== undefined;
    const compare = (a, b) => {
      const [x, y] = [value(a, key), value(b, key)];
      // What has no value comes last, whichever way.
      if (x === '' || y === '') return (x === '') - (y === '');
      const order = numeric ? Number(x) - Number(y) : x.localeCompare(y);
      return descending ? -order : order;
    };
    table.append(...[...rows].sort(compare));
  }));
  all('.copy').forEach((button) => {
    if (!navigator.clipboard) { button.hidden = true; return; }
    button.addEventListener('click', async () => {
      const said = button.textContent;
      try { await navigator.clipboard.writeText(button.previousElementSibling.textContent); button.textContent = 'Copied'; }
      catch { button.textContent = 'Cannot copy'; }
      setTimeout(() => { button.textContent = said; }, 1500);
    });
  });
  const follow = () => {
    const row = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
    if (!row || !rows.includes(row)) return;
    open(row, true);
    row.scrollIntoView();
  };
  addEventListener('hashchange', follow);
  filter();
  follow();
})();
