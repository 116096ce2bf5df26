// Exercises a report as a reader would, and tells the page around it what it found.
(async () => {
  'use strict';
  const findings = [];
  const check = (name, test) => {
    let detail;
    try { detail = test(); } catch (error) { detail = `threw ${error}`; }
    findings.push({ name, fine: detail === true, detail: String(detail).replace(/[<>&]/g, ' ') });
  };
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  // A copy that is made to be read; the page's own canvases are made to be drawn.
  const copied = (canvas, x, y, width, height) => {
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [width, height];
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, x, y, width, height, 0, 0, width, height);
    return context.getImageData(0, 0, width, height).data;
  };
  const pixels = (canvas) => copied(canvas, 0, 0, canvas.width, canvas.height);
  const print = (canvas) => { let hash = 0; for (const x of pixels(canvas)) hash = (Math.imul(hash, 31) + x) | 0; return hash; };
  const at = (canvas, u, v) => [...copied(canvas, Math.floor(u * canvas.width), Math.floor(v * canvas.height), 1, 1)];
  const same = (found, expected) => (JSON.stringify(found) === JSON.stringify(expected) ? true : `${JSON.stringify(found)} for ${JSON.stringify(expected)}`);
  const press = (target, key, more = {}) => target.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true, ...more }));
  const unseen = (element) => element.getClientRects().length === 0;
  const table = document.querySelector('table.decisions');
  const pause = (milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });

  if (table) {
    const rows = [...table.tBodies];
    const form = document.querySelector('.filters');
    const visible = () => rows.filter((row) => row.getClientRects().length).map((row) => row.id.slice(3)).join(' ');
    const every = rows.map((row) => row.id.slice(3)).join(' ');
    const set = (input, value) => {
      if (input.type === 'checkbox') input.checked = value; else input.value = value;
      input.dispatchEvent(new Event('input', { bubbles: true }));
    };
    const box = (value) => form.querySelector(`[value=${value}]`);
    check('rows are folded and undrawn at first', () =>
      rows.every((row) => unseen(row.querySelector('.detail'))) && all('.viewer').every((v) => !v.dataset.started));
    check('filters hide rows by outcome', () => {
      set(box('passed'), false);
      const found = visible();
      set(box('passed'), true);
      return same(found, rows.filter((row) => row.dataset.outcome !== 'passed').map((row) => row.id.slice(3)).join(' '));
    });
    check('filters hide rows by kind', () => {
      const kind = form.querySelector('[name=kind]');
      set(kind, 'noise');
      const found = visible();
      set(kind, '');
      return same(found, rows.filter((row) => row.dataset.kind === 'noise').map((row) => row.id.slice(3)).join(' '));
    });
    check('filters hide mutants', () => {
      set(form.querySelector('[name=mutants]'), false);
      const found = visible();
      set(form.querySelector('[name=mutants]'), true);
      return same(found, '0 2 3 4 5 6');
    });
    check('filters find words', () => {
      set(form.querySelector('[name=text]'), 'IRRADIANCE-sphere mutant');
      const found = visible();
      const count = form.querySelector('.count').textContent;
      set(form.querySelector('[name=text]'), '');
      return same([found, count, visible()], ['1', '1 of 7 rows shown', every]);
    });
    check('columns sort both ways', () => {
      const head = table.querySelector('th[data-key=seconds]');
      const order = () => [...table.tBodies].map((row) => Number(row.querySelector('[data-key=seconds]').dataset.value));
      head.querySelector('button').click();
      const up = order(), first = head.getAttribute('aria-sort');
      head.querySelector('button').click();
      const down = order(), second = head.getAttribute('aria-sort');
      table.querySelector('th[data-key=outcome] button').click();
      const outcomes = [...table.tBodies].map((row) => row.dataset.outcome);
      const sorted = [...up].sort((a, b) => a - b);
      return same([up, first, down, second, outcomes[0], outcomes.at(-1)],
        [sorted, 'ascending', [...sorted].reverse(), 'descending', 'failed', 'passed']);
    });
    check('a row unfolds and folds', () => {
      const toggle = document.querySelector('#row0 .toggle'), detail = document.querySelector('#row0 .detail');
      toggle.focus();
      const states = [document.activeElement === toggle];
      for (let i = 0; i < 3; i++) { toggle.click(); states.push(!unseen(detail), toggle.getAttribute('aria-expanded')); }
      return same(states, [true, true, 'true', false, 'false', true, 'true']);
    });
    check('an address unfolds its row', () => {
      location.hash = '#row5';
      dispatchEvent(new HashChangeEvent('hashchange'));
      const found = !unseen(document.querySelector('#row5 .detail'));
      history.replaceState(null, '', location.pathname);
      return found;
    });
    document.querySelector('[data-open=yes]').click();
    check('all rows unfold', () => rows.every((row) => !unseen(row.querySelector('.detail'))));
    check('every plot is there', () => same(
      ['.running', '.plot .fit', '.plot rect.s1', '.p-map', '.histogram', '.interval', '.refusals'].map((s) => all(s).length > 0),
      Array(7).fill(true)));
  }

  const viewer = document.querySelector('.viewer');
  const pair = viewer.querySelector('canvas.pair'), map = viewer.querySelector('canvas.map'), divider = viewer.querySelector('[role=slider]');
  const range = viewer.querySelector('input[type=range]');
  viewer.scrollIntoView();
  // Ten seconds are plenty.
  for (let i = 0; i < 500 && !viewer.dataset.started; i++) await pause(20);
  check('pictures are drawn once they are in sight', () => viewer.dataset.started === 'yes');
  if (table) check('what is out of sight is not drawn', () => !all('.viewer').at(-1).dataset.started);
  const [first, second] = ['.left', '.right'].map((side) => viewer.querySelector(side).textContent);
  const press_button = (name) => viewer.querySelector(`[data-do=${name}]`).click();
  const stops = (value) => { range.value = value; range.dispatchEvent(new Event('input', { bubbles: true })); };
  check('the slider is reached by keyboard', () => {
    divider.focus();
    return document.activeElement === divider && divider.tabIndex === 0 && Boolean(divider.getAttribute('aria-label'));
  });
  check('the slider moves by arrow keys, and the picture with it', () => {
    const before = print(pair);
    press(divider, 'ArrowLeft');
    press(divider, 'ArrowLeft', { shiftKey: true });
    return same([divider.getAttribute('aria-valuenow'), divider.style.left, print(pair) !== before], ['39', '39%', true]);
  });
  check('the slider is dragged', () => {
    const rect = pair.getBoundingClientRect();
    const event = (name, share) => new PointerEvent(name, { bubbles: true, button: 0, clientX: rect.left + share * rect.width, clientY: rect.top + 5 });
    const before = print(pair);
    divider.dispatchEvent(event('pointerdown', 0.39));
    window.dispatchEvent(event('pointermove', 0.8));
    window.dispatchEvent(event('pointerup', 0.8));
    window.dispatchEvent(event('pointermove', 0.1));
    return same([divider.getAttribute('aria-valuenow'), print(pair) !== before], ['80', true]);
  });
  check('F and the button flip', () => {
    const seen = [];
    press(divider, 'f'); seen.push(divider.getAttribute('aria-valuetext'));
    const picture = print(pair);
    press_button('flip'); seen.push(divider.getAttribute('aria-valuetext'));
    return same([seen, picture !== print(pair)], [[`${second} alone`, `${first} alone`], true]);
  });
  // The second picture is 0.25 everywhere: sRGB codes 137, 188 and 255 at 0, 1 and 2 stops.
  check('exposure is linear and honest', () => {
    press(divider, 'Home');
    const codes = [0, 1, 2, -1].map((value) => { stops(value); return at(pair, 0.3, 0.4)[1]; });
    const output = viewer.querySelector('output').textContent;
    press_button('zero');
    return same([codes, output, range.value, at(pair, 0.3, 0.4)], [[137, 188, 255, 99], '−1.0 EV', '0', [137, 137, 137, 255]]);
  });
  check('both pictures share the exposure', () => {
    press(divider, 'End');
    stops(0);
    const dark = at(pair, 0.3, 0.4)[1];
    stops(1);
    const bright = at(pair, 0.3, 0.4)[1];
    press_button('auto');
    return bright > dark + 30 && bright < 230 ? true : `${dark} ${bright}`;
  });
  check('the map is signed, and its scale matters', () => {
    const target = document.querySelector(table ? '#row1 .viewer' : '.viewer');
    if (table) for (let i = 0; i < 2; i++) document.querySelector('#row1 .toggle').click();
    const canvas = target.querySelector('canvas.map'), scale = target.querySelector('[data-do=scale]');
    // Brighter by 20 % in the right half, as dark on average in the left.
    scale.value = '0.3';
    scale.dispatchEvent(new Event('change', { bubbles: true }));
    const sum = (from, to) => {
      let [red, blue] = [0, 0];
      const data = pixels(canvas), { width } = canvas;
      for (let i = 0; i < data.length / 4; i++) if (i % width >= from * width && i % width < to * width) { red += data[4 * i]; blue += data[4 * i + 2]; }
      return red - blue;
    };
    const wide = print(canvas), [left, right] = [sum(0, 0.5), sum(0.5, 1)];
    scale.value = '0.01';
    scale.dispatchEvent(new Event('change', { bubbles: true }));
    return same([left < 0, right > 0, print(canvas) !== wide, target.querySelector('.high').textContent], [true, true, true, '+1 %']);
  });
  check('the map shows standard errors', () => {
    const choice = viewer.querySelector('[data-do=map]');
    const before = print(map);
    choice.value = 'deviation';
    choice.dispatchEvent(new Event('change', { bubbles: true }));
    return same([print(map) !== before, viewer.querySelector('.about').textContent.includes('standard error')], [true, true]);
  });
  check('a pixel tells its numbers', () => {
    const rect = map.getBoundingClientRect();
    map.dispatchEvent(new PointerEvent('pointermove', { bubbles: true, clientX: rect.left + 0.3 * rect.width, clientY: rect.top + 0.4 * rect.height }));
    const text = viewer.querySelector('.readout').textContent;
    return text.includes(`${second}: 0.2500  0.2500  0.2500`) && text.includes('%') ? true : text;
  });

  check('arrow keys read pixels', () => {
    map.focus();
    const before = viewer.querySelector('.readout').textContent;
    press(map, 'ArrowRight');
    const place = (text) => text.match(/\((\d+), (\d+)\)/).slice(1).map(Number);
    const [[x, y], [u, v]] = [before, viewer.querySelector('.readout').textContent].map(place);
    return same([document.activeElement === map, u - x, v - y], [true, 1, 0]);
  });

  const luminance = (colour) => {
    const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map((x) => { const c = x / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const probe = document.body.appendChild(document.createElement('i'));
  const colour = (name) => { probe.style.color = `var(--${name})`; return luminance(getComputedStyle(probe).color); };
  // WCAG 2.2, 1.4.3: text 4.5 to 1.
  const contrast = () => {
    const weak = [];
    for (const text of ['text', 'quiet', 'accent', 'good', 'bad', 'open']) for (const ground of ['page', 'card', 'soft']) {
      const [a, b] = [colour(text), colour(ground)].sort((x, y) => y - x);
      if ((a + 0.05) / (b + 0.05) < 4.5) weak.push(`${text} on ${ground}: ${((a + 0.05) / (b + 0.05)).toFixed(2)}`);
    }
    return weak.length ? weak.join(', ') : true;
  };
  check('the theme has a button, and both themes have contrast', () => {
    const button = document.querySelector('.theme');
    const seen = [];
    for (const expected of ['light', 'dark']) {
      button.click();
      seen.push(document.documentElement.dataset.theme === expected, contrast(), luminance(getComputedStyle(document.body).backgroundColor) > 0.5);
    }
    button.click();
    return same([seen, document.documentElement.dataset.theme ?? 'none'], [[true, true, true, true, true, false], 'none']);
  });
  check('the page is no wider than the window', () => {
    const wide = document.documentElement.scrollWidth, room = document.documentElement.clientWidth;
    if (wide <= room) return true;
    const culprits = all('main *').filter((e) => e.getBoundingClientRect().right > room + 1 && !e.closest('.scroll, .plot')).slice(0, 4);
    return `${wide} in ${room}: ${culprits.map((e) => `${e.tagName}.${e.className}`).join(', ')}`;
  });
  check('the window is as asked for', () => same(innerWidth, WIDTH));
  check('everything has a name, and ids are unique', () => {
    const ids = all('[id]').map((e) => e.id);
    const nameless = [
      ...all('button').filter((e) => !e.textContent.trim()),
      ...all('input, select').filter((e) => !e.closest('label') && !e.getAttribute('aria-label')),
      ...all('canvas, svg[role=img], [role=slider]').filter((e) => !e.getAttribute('aria-label')),
      ...all('img').filter((e) => !e.alt),
    ].map((e) => e.outerHTML.slice(0, 60));
    return same([ids.length - new Set(ids).size, nameless], [0, []]);
  });
  check('pictures keep their shape', () => all('.viewer[data-started] .frame canvas').every((canvas) => {
    const rect = canvas.getBoundingClientRect();
    return Math.abs(rect.width / rect.height - canvas.width / canvas.height) < 0.02;
  }));
  check('no drawing has a number that is none', () => all('svg *').every((e) => [...e.attributes].every((a) => !/NaN|inf/i.test(a.value))));
  check('the skip link leads to the content', () => {
    const link = document.querySelector('a.skip');
    return Boolean(document.querySelector(link.getAttribute('href')));
  });
  await pause(100);
  check('nothing failed on the way', () => same(window.failures, []));
  parent.postMessage(findings, '*');
})();
