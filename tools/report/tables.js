// Tables: sortable by each column, shown in pages, saved as CSV.

// How many letters wide a title is in two lines.
function lettersInTwoLines(title) {
  const words = title.split(' '), length = some => some.join(' ').length;
  return Math.min(...words.map((_, k) => Math.max(length(words.slice(0, k)), length(words.slice(k)))));
}

// columns: [{field, title, digits, text, cell(row)}]; numbers are aligned to the right.
function sortableTable(columns, list, { page = 100, name = '' } = {}) {
  const state = { sorted: [...list], column: null, descending: false, shown: page };
  const body = element('tbody');
  const more = element('button', { type: 'button', onclick: () => { state.shown += page; fill(); } });
  const numeric = new Map(columns.map(column => [column, !column.text && list.length > 0 &&
    list.every(row => isNumeric(row[column.field]))]));

  const headers = columns.map(column => element('th', {
    scope: 'col', class: numeric.get(column) ? 'number' : null,
    style: `min-width: calc(${lettersInTwoLines(column.title)}ch + 1.2rem)`,  // with the cell's own room
  }, element('button', { type: 'button', onclick: () => sortBy(column) }, column.title)));

  function sortBy(column) {
    state.descending = state.column === column && !state.descending;
    state.column = column;
    const sign = state.descending ? -1 : 1;
    state.sorted = [...list].sort((a, b) => compare(a[column.field], b[column.field], sign));
    headers.forEach((header, k) => header.setAttribute('aria-sort',
      columns[k] !== column ? 'none' : state.descending ? 'descending' : 'ascending'));
    fill();
  }
  function fill() {
    body.replaceChildren(...state.sorted.slice(0, state.shown).map(row => element('tr', {},
      ...columns.map(column => tableCell(column, row, numeric.get(column))))));
    const left = state.sorted.length - state.shown;
    more.hidden = left <= 0;
    more.textContent = `Show ${Math.min(page, left)} more of ${state.sorted.length} rows`;
  }
  fill();
  const save = name === '' ? null : element('button', { type: 'button', onclick: () =>
    download(fileName(name) + '.csv', tableCsv(columns, list), 'text/csv') }, 'CSV');
  return element('div', {},
    element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': name || 'values' },
      element('table', {}, element('thead', {}, element('tr', {}, ...headers)), body)),
    element('div', { class: 'row' }, more, save));
}

function tableCell(column, row, isNumber) {
  const value = row[column.field];
  if (isNumber) return element('td', { class: 'number' }, show(asNumber(value), column.digits));
  const content = column.cell ? column.cell(row) : show(value, column.digits);
  const isLong = typeof content === 'string' && content.length > 40;
  return element('td', { class: isLong ? 'long' : 'text' }, content);
}
const tableCsv = (columns, list) => csvText(columns.map(column => column.title),
  list.map(row => Object.fromEntries(columns.map(column => [column.title, row[column.field]]))));

// CSV tables of the folder hold text; what is missing does not make a column one of words.
const asNumber = value => typeof value !== 'string' ? value
  : value.trim() === '' || value === 'nan' ? null : Number(value);
function isNumeric(value) {
  if (value === null || value === undefined || typeof value === 'number') return true;
  return typeof value === 'string' && (asNumber(value) === null || !Number.isNaN(asNumber(value)));
}

// Numbers by size, texts by letters; what is missing stays last when the sign turns.
function compare(a, b, sign) {
  const [x, y] = [a, b].map(value => isNumeric(value) ? asNumber(value) : textOf(value));
  const missing = value => value === null || value === undefined || value === '';
  if (missing(x) || missing(y)) return missing(x) - missing(y);
  if (typeof x === 'number' && typeof y === 'number') return sign * (x - y);
  return sign * String(x).localeCompare(String(y), 'en', { numeric: true });
}

function select(label, options, value, onchange) {
  const node = element('select', { onchange: () => onchange(node.value) },
    ...options.map(([name, text]) => element('option', { value: name }, text)));
  node.value = value;
  return element('label', {}, label + ' ', node);
}
// A choice among some of the groups: those are offered that pass the filters.
function groupChoice(groups, onchange) {
  const label = select('Problem', [], '', value => onchange(Number(value)));
  const node = label.querySelector('select');
  // The one that is chosen then: another where that of before does not pass, undefined where none does.
  const offer = passing => {
    const left = groups.filter(group => passing.has(group)), before = Number(node.value || -1);
    node.replaceChildren(...left.map(group => element('option', { value: group }, groupName(group))));
    const now = left.includes(before) ? before : left[0];
    node.value = String(now ?? '');
    return now;
  };
  return { label, offer };
}
function check(label, checked, onchange) {
  const node = element('input', { type: 'checkbox', checked, onchange: () => onchange(node.checked) });
  return element('label', {}, node, label);
}
function definitions(object) {
  return element('dl', {}, ...Object.entries(object).flatMap(([name, value]) =>
    [element('dt', {}, name), element('dd', {}, show(textOf(value)))]));
}
