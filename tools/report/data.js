// The data of the page: rows with what is derived from them, filters, colours, numbers as text.

const parse = id => JSON.parse(document.getElementById(id).textContent);
const doc = parse('summary-data');
// Large, and needed only where a plot or the player comes into view.
const later = id => { let value; return () => (value ??= parse(id)); };
const traces = later('traces-data');
const curves = later('curves-data');

const kReached = new Set(['solved', 'gradient_small', 'step_small', 'rounding_floor']);
// A line search or a library ended the run: reached where |g| is small all the same.
const kReachedIfSmall = new Set(['line_search_ended', 'native_stop']);

const isNumber = value => typeof value === 'number' && Number.isFinite(value);

function readRows() {
  const { common, fields, rows } = doc.cells;
  return rows.map((values, index) => {
    const row = { ...common };
    fields.forEach((field, k) => { row[field] = values[k]; });
    return derive(row, index);
  });
}

function derive(row, index) {
  row.index = index;
  row.group = doc.group_of[index];
  row.problem = String(row.problem ?? '(no problem)');
  row.solver = String(row.solver ?? '(no solver)');
  row.stop = String(row.stop ?? '');
  row.termList = String(row.terms ?? '').split(',').filter(Boolean);
  if (row.termList.length === 0) row.termList = ['(not said)'];
  row.verdict = verdictOf(row);
  const counts = ['energy_calls', 'gradient_calls', 'jacobian_calls', 'products'].map(f => row[f]);
  row.evaluations = counts.some(isNumber) ? counts.reduce((sum, n) => sum + (n ?? 0), 0) : null;
  // As in the tables of bench: the time of one evaluation of E, measured on the instance, is the unit.
  const unit = doc.groups[row.group].unit_seconds;
  if (isNumber(unit)) row.work_units = isNumber(row.seconds) ? row.seconds / unit : null;
  return row;
}

// What bench has found against a run (docs/formats.md).
const finds = (row, what) => Array.isArray(row.findings) && row.findings.includes(what);

// skipped | reached | failed (did not reach what was asked) | refuted (claims what is not so).
function verdictOf(row) {
  if (row.stop === 'skipped') return 'skipped';
  if (row.verified === false || row.disagreement || finds(row, 'claim_fails')) return 'refuted';
  if (kReached.has(row.stop)) return 'reached';
  if (!kReachedIfSmall.has(row.stop)) return 'failed';
  if (row.stop === 'native_stop' && row.mode === 'native') return 'reached';
  const asked = Math.max((row.gradient_tolerance ?? 0) * (row.start_gradient_norm ?? 0),
                         row.gradient_floor ?? 0, row.line_search_floor ?? 0);
  return isNumber(row.gradient_norm) && row.gradient_norm <= asked ? 'reached' : 'failed';
}

const rows = readRows();
const inOrder = values => [...new Set(values)];
const allProblems = inOrder(rows.map(row => row.problem));
const allSolvers = inOrder(rows.map(row => row.solver));
const allTerms = inOrder(rows.flatMap(row => row.termList));
const allExperiments = inOrder(rows.map(row => row.experiment ?? ''));  // of reproductions
const isOverlapped = row => row.overlapped === true;
const hasWorkUnits = rows.some(row => isNumber(row.work_units) && !isOverlapped(row));

const filters = {
  problem: new Set(allProblems), solver: new Set(allSolvers), term: new Set(allTerms),
  experiment: new Set(allExperiments),
};
let chosen = rows;  // the rows that pass
function applyFilters() {
  chosen = rows.filter(row => filters.problem.has(row.problem) && filters.solver.has(row.solver) &&
                              filters.experiment.has(row.experiment ?? '') &&
                              row.termList.some(term => filters.term.has(term)));
}

// --- Colours: those of Okabe and Ito (2008), darkened or lightened for the two schemes. Solver k
// has colour k mod 8, and dash and mark k / 8, in every plot.
const kPalettes = {
  light: ['#0072b2', '#d55e00', '#009e73', '#c2589a', '#a67c00', '#4aa3df', '#5b3fa0', '#4a4a4a'],
  dark: ['#4fa8e0', '#ff8a3d', '#2ec79a', '#e69ac4', '#e6c229', '#a9dcff', '#b79be8', '#d0d0d0'],
};
const kDashes = [[1, 0], [8, 4], [2, 3], [8, 3, 2, 3], [16, 4], [8, 3, 2, 3, 2, 3]];
const kShapes = ['circle', 'square', 'triangle-up', 'diamond', 'triangle-down', 'cross'];
let scheme = 'light';
const colourOf = solver => kPalettes[scheme][allSolvers.indexOf(solver) % 8];
const lookOf = (solver, looks) => looks[Math.floor(allSolvers.indexOf(solver) / 8) % looks.length];
const isMarked = solver => allSolvers.indexOf(solver) >= 8;  // colour and a full line tell no more

// --- Text.
function show(value, digits = 4) {
  if (value === null || value === undefined || value === '') return '–';
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value !== 'number') return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(digits)))
                                    : value.toExponential(digits - 1);
}
function counted(number, one, many = one + 's') { return `${number} ${number === 1 ? one : many}`; }
function median(values) {
  const sorted = values.filter(isNumber).sort((a, b) => a - b);
  const middle = Math.floor(sorted.length / 2);
  if (sorted.length === 0) return null;
  return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}
const textOf = value =>
  value !== null && typeof value === 'object' ? JSON.stringify(value) : String(value ?? '');

const severalNames = new Set(['terms', 'data_seed', 'start_seed'].filter(name =>
  new Set(doc.groups.map(group => group[name])).size > 1));
function groupName(index) {
  const group = doc.groups[index];
  const several = name => severalNames.has(name);
  const parts = [String(group.problem ?? '(no problem)')];
  if (several('terms') && group.terms) parts.push(String(group.terms));
  for (const [field, word] of [['data_seed', 'data seed'], ['start_seed', 'start']]) {
    if (several(field) && group[field] > 0) parts.push(`${word} ${group[field]}`);  // 0: none
  }
  return parts.join(', ');
}

// --- Elements. Text goes in as text only: names and messages may hold anything.
function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter(child => child !== null && child !== undefined));
  return node;
}

function csvText(columns, list) {
  const field = value => {
    const text = textOf(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...list.map(row => columns.map(column => row[column]))]
    .map(line => line.map(field).join(',') + '\n').join('');
}
function download(name, content, type) {
  const address = content instanceof Blob || !content.startsWith('data:')
    ? URL.createObjectURL(new Blob([content], { type })) : content;
  const link = element('a', { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  if (address !== content) setTimeout(() => URL.revokeObjectURL(address), 10000);
}
const fileName = text => text.replace(/[^A-Za-z0-9]+/g, '_').replace(/^_|_$/g, '').toLowerCase();
