// Puts the page together: header, filters, sections; redraws what the filters change.

const kSchemes = ['system', 'light', 'dark'];
let wantedScheme = 'system';
const systemDark = matchMedia('(prefers-color-scheme: dark)');
function setScheme() {
  scheme = wantedScheme === 'system' ? (systemDark.matches ? 'dark' : 'light') : wantedScheme;
  document.documentElement.dataset.scheme = scheme;
  document.getElementById('scheme').textContent =
    'Colours: ' + (wantedScheme === 'system' ? 'as the system' : wantedScheme);
}

// Vega's shapes around (17, 5).
const kMarkPaths = {
  square: 'M13.5 1.5h7v7h-7z', 'triangle-up': 'M17 .5l4.5 8.5h-9z', diamond: 'M17 0l5 5-5 5-5-5z',
  'triangle-down': 'M17 9.5l-4.5-8.5h9z', cross: 'M15.3 .5h3.4v2.8h2.8v3.4h-2.8v2.8h-3.4v-2.8h-2.8v-3.4h2.8z',
  circle: 'M13 5a4 4 0 1 0 8 0a4 4 0 1 0-8 0z',
};
function swatch(solver) {
  const dash = lookOf(solver, kDashes);
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  const line = document.createElementNS('http://www.w3.org/2000/svg', 'line');
  for (const [name, value] of Object.entries({ width: 34, height: 10, 'aria-hidden': 'true' })) {
    svg.setAttribute(name, value);
  }
  const shape = { x1: 1, x2: 33, y1: 5, y2: 5, 'stroke-width': 3, stroke: colourOf(solver),
                  'stroke-dasharray': dash[1] === 0 ? 'none' : dash.join(' ') };
  for (const [name, value] of Object.entries(shape)) line.setAttribute(name, value);
  svg.append(line);
  if (isMarked(solver)) {
    const mark = document.createElementNS('http://www.w3.org/2000/svg', 'path');
    mark.setAttribute('d', kMarkPaths[lookOf(solver, kShapes)]);
    mark.setAttribute('fill', colourOf(solver));
    svg.append(mark);
  }
  return svg;
}

function choiceList(kind, title, values) {
  const boxes = values.map(value => {
    const box = element('input', { type: 'checkbox', checked: true, onchange: () => {
      if (box.checked) filters[kind].add(value); else filters[kind].delete(value);
      update();
    } });
    box.value = value;
    return box;
  });
  const setAll = on => {
    boxes.forEach(box => { box.checked = on; });
    filters[kind] = new Set(on ? values : []);
    update();
  };
  const labels = values.map((value, k) => element('label', {}, boxes[k],
    kind === 'solver' ? swatch(value) : null, value));
  return element('fieldset', { 'data-filter': kind }, element('legend', {}, title),
    element('div', { class: 'row' },
      element('button', { type: 'button', onclick: () => setAll(true) }, 'All'),
      element('button', { type: 'button', onclick: () => setAll(false) }, 'None')),
    element('div', { class: 'choices' }, ...labels));
}

function filterSection() {
  const box = element('details', { open: innerWidth > 700, id: 'filters' },
    element('summary', {}, element('span', { id: 'num-chosen', 'aria-live': 'polite' })),
    element('div', { class: 'filters' },
      allExperiments.length > 1 ? choiceList('experiment', 'Experiments', allExperiments) : null,
      choiceList('problem', 'Problems', allProblems), choiceList('solver', 'Solvers', allSolvers),
      choiceList('term', 'Terms', allTerms)));
  return box;
}
function recolourSwatches() {
  document.querySelectorAll('[data-filter="solver"] label').forEach((label, k) => {
    label.querySelector('svg').replaceWith(swatch(allSolvers[k]));
  });
}

const sections = [];  // {title, node, update}
function addSection(title, node, updateNode = () => {}) {
  const id = fileName(title);
  const section = element('section', { id }, element('h2', {}, title), node);
  document.getElementById('main').append(section);
  document.getElementById('contents').append(element('a', { href: '#' + id }, title));
  sections.push({ title, node, update: updateNode });
}

// A section of runs: where none passes the filters, a sentence stands in its place.
function addRunSection(title, node, updateNode) {
  const none = element('p', { class: 'none' }, 'No run passes the filters.');
  addSection(title, element('div', {}, none, node), () => {
    none.hidden = chosen.length > 0;
    node.hidden = chosen.length === 0;
    updateNode();
  });
}

function update() {
  applyFilters();
  const filtered = document.getElementById('num-chosen');
  if (filtered) filtered.textContent = `Filters: ${chosen.length} of ${counted(rows.length, 'run')}`;
  for (const section of sections) section.update();
}
function redraw() {
  setScheme();
  recolourSwatches();
  allPlots.forEach(plot => plot.refresh());
}

function start() {
  setScheme();
  document.title = `Batten report: ${doc.name}`;
  document.getElementById('title').textContent = document.title;
  const about = [counted(rows.length, 'run'), counted(allProblems.length, 'problem'),
                 counted(allSolvers.length, 'solver')].join(', ');
  document.getElementById('subtitle').textContent =
    (rows.length > 0 ? about + '. ' : '') + `Made by batten ${doc.version} (${doc.commit}).`;
  const main = document.getElementById('main');
  if (doc.notes.length > 0) {
    main.append(element('div', { role: 'note' },
      ...doc.notes.map(note => element('p', { class: 'bad' }, 'Note: ' + note))));
  }
  // What a reproduction says about its paper comes first.
  const shown = addPages();
  if (rows.length > 0) {
    main.append(filterSection());
    addRunSections();
  } else if (doc.tables.length === 0) {
    main.append(element('p', {}, 'No run is finished yet.'));
  }
  addFolderSections(shown);
  update();
  document.getElementById('scheme').addEventListener('click', () => {
    wantedScheme = kSchemes[(kSchemes.indexOf(wantedScheme) + 1) % kSchemes.length];
    redraw();
  });
  systemDark.addEventListener('change', redraw);
  let width = innerWidth, timer;
  addEventListener('resize', () => {
    if (innerWidth === width) return;  // phones: the address bar comes and goes
    width = innerWidth;
    clearTimeout(timer);
    timer = setTimeout(() => allPlots.forEach(plot => plot.refresh()), 150);
  });
  document.documentElement.dataset.ready = 'yes';
}
start();
