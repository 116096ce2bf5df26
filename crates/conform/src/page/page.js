// Filters and sorts the questions, and unfolds the one that a link leads to.
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const form = document.querySelector('.filters'), table = document.querySelector('.matrix');
  const body = table.tBodies[0], questions = all('details.question'), rows = [...body.rows];

  const filter = () => {
    const chosen = new FormData(form), verdicts = new Set(chosen.getAll('verdict'));
    const words = chosen.get('text').toLowerCase().split(/\s+/).filter(Boolean);
    const fits = ({ dataset }) => dataset.verdicts.split(' ').some((verdict) => verdicts.has(verdict))
      && words.every((word) => dataset.search.includes(word));
    [...rows, ...questions].forEach((element) => { element.hidden = !fits(element); });
    form.querySelector('.count').textContent = `${rows.filter(fits).length} of ${rows.length} questions shown`;
  };
  form.addEventListener('input', filter);
  form.addEventListener('submit', (event) => event.preventDefault());
  form.addEventListener('reset', () => setTimeout(filter));

  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => head.querySelector('button').addEventListener('click', () => {
    const descending = head.getAttribute('aria-sort') === 'ascending';
    heads.forEach((other) => other.removeAttribute('aria-sort'));
    head.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    const value = (row) => Number(row.cells[column].dataset.value);
    body.append(...[...rows].sort((a, b) => (descending ? value(b) - value(a) : value(a) - value(b))));
  }));

  all('[data-unfold]').forEach((button) => button.addEventListener('click', () => {
    questions.filter((question) => !question.hidden).forEach((question) => { question.open = button.dataset.unfold === 'yes'; });
  }));

  all('.copy').forEach((button) => {
    if (!navigator.clipboard) { button.hidden = true; return; }
    button.addEventListener('click', async () => {
      try { await navigator.clipboard.writeText(button.previousElementSibling.textContent); button.textContent = 'Copied'; }
      catch { button.textContent = 'Cannot copy'; }
      setTimeout(() => { button.textContent = 'Copy'; }, 1500);
    });
  });

  const follow = (hash) => {
    const question = hash.length > 1 && document.getElementById(decodeURIComponent(hash.slice(1)));
    if (!question || !questions.includes(question)) return;
    question.open = true;
    question.scrollIntoView();
  };
  // A link to where one is already changes no address.
  all('a', body).forEach((link) => link.addEventListener('click', () => follow(link.hash)));
  addEventListener('hashchange', () => follow(location.hash));
  filter();
  follow(location.hash);
})();
