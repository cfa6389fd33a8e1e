// A plot: a Vega-Lite specification with its caption, zoom by pointer and by keys, a table of its
// values, and its data and pictures to download. Drawn when it comes into view.

const kFont = 'system-ui, "DejaVu Sans", sans-serif';
const kTitleSize = 12;  // pixels
// Where Vega breaks lines: an em space, since it puts names of axes into code, which a newline would break.
const kBreak = '\u2003';
function vegaConfig() {
  const dark = scheme === 'dark';
  const text = dark ? '#e4e7ea' : '#1c1f23', line = dark ? '#59616b' : '#9aa2ab';
  const grid = dark ? '#2a3037' : '#e8ebee';
  return {
    background: dark ? '#15181c' : '#ffffff', font: kFont, lineBreak: kBreak,
    axis: { labelColor: text, titleColor: text, gridColor: grid, domainColor: line, tickColor: line,
            labelFontSize: 12, titleFontSize: kTitleSize, titleFontWeight: 'normal', labelOverlap: true },
    // There it is whole however wide the numbers of the other axis are; in the middle it is not.
    axisX: { titleAnchor: 'end' },
    legend: { labelColor: text, titleColor: text, labelFontSize: 12,
              symbolStrokeWidth: 2 },
    header: { labelColor: text, titleColor: text, labelFontSize: 12 },
    view: { stroke: line }, text: { color: text },
  };
}

const allPlots = [];
const whenSeen = new IntersectionObserver(entries => {
  for (const entry of entries) entry.target.plot.seen(entry.isIntersecting);
}, { rootMargin: '200px' });

class Plot {
  // build(width): {spec, data, columns, caption} or {caption} where there is nothing to draw.
  // `data` is what the spec's dataset "rows" holds, `more` other datasets, `columns` what of it is downloaded, by title.
  // `controls` stand above it.
  constructor(title, build, controls = null) {
    Object.assign(this, { title, build, isSeen: false, isStale: true, isDone: Promise.resolve() });
    this.label = `${title}. Keys: plus and minus zoom, arrows move, 0 shows all.`;
    this.view = element('div', {
      class: 'view', tabindex: 0, role: 'group', onkeydown: event => this.key(event),
      'aria-label': this.label,
    });
    this.caption = element('figcaption');
    this.table = element('div');
    this.tableButton = this.button('Values', () => this.toggleTable());
    this.buttons = element('div', { class: 'row' },
      this.button('+', () => this.zoom(0.6), 'Zoom in'),
      this.button('−', () => this.zoom(1 / 0.6), 'Zoom out'),
      this.button('Show all', () => this.reset()), this.tableButton,
      this.button('CSV', () => this.saveCsv()), this.button('SVG', () => this.saveSvg()),
      this.button('PNG', () => this.savePng()));
    this.figure = element('figure', {}, element('h3', {}, title), controls, this.view, this.buttons,
                          this.table, this.caption);
    this.figure.plot = this;
    allPlots.push(this);
    whenSeen.observe(this.figure);
  }

  button(text, onclick, label) {
    return element('button', { type: 'button', onclick, 'aria-label': label }, text);
  }
  seen(isSeen) {
    this.isSeen = isSeen;
    if (isSeen && this.isStale) this.draw();
  }
  refresh() {
    this.isStale = true;
    if (this.isSeen) this.draw();
  }
  draw() {
    this.isStale = false;
    this.isDone = this.isDone.then(() => this.drawNow());
    return this.isDone;
  }
  async drawNow() {
    const width = Math.max(220, Math.floor(this.view.clientWidth || this.figure.clientWidth));
    this.drawn = this.build(width);
    this.caption.textContent = this.drawn.caption;
    this.buttons.hidden = this.view.hidden = !this.drawn.spec;
    this.result?.finalize();
    this.result = null;
    this.view.replaceChildren();
    this.showTable();
    if (!this.drawn.spec) return;
    // Vega takes the description for the label of the view.
    const spec = { $schema: 'https://vega.github.io/schema/vega-lite/v6.json', ...this.drawn.spec,
                   description: this.label, datasets: { rows: this.drawn.data, ...this.drawn.more } };
    this.result = await vegaEmbed(this.view, spec, {
      actions: false, config: vegaConfig(), renderer: 'canvas', ast: false, patch: withWholeNames,
      tooltip: { theme: scheme === 'dark' ? 'dark' : 'light' },
      loader: { load: () => Promise.reject(new Error('this page loads nothing')) },
    });
    this.full = this.domains();
  }

  // --- Zoom. The interval selection `zoom` is bound to the scales of the fields px and py.
  domains() {
    if (!this.drawn.zooms) return null;
    const view = this.result.view;
    return { px: [...view.scale('x').domain()], py: [...view.scale('y').domain()] };
  }
  async setDomains(change) {
    const now = this.result && this.domains();
    if (!now) return;
    for (const field of ['px', 'py']) {
      const isLog = this.drawn.logs[field];
      const [low, high] = now[field].map(value => isLog ? Math.log(value) : value);
      const next = change(low, high, field).map(value => isLog ? Math.exp(value) : value);
      if (next.every(Number.isFinite)) this.result.view.signal(`zoom_${field}`, next);
    }
    await this.result.view.runAsync();
  }
  zoom(factor) {
    return this.setDomains((low, high) => {
      const middle = (low + high) / 2, half = (high - low) / 2 * factor;
      return [middle - half, middle + half];
    });
  }
  move(x, y) {
    return this.setDomains((low, high, field) => {
      const step = (high - low) * (field === 'px' ? x : y);
      return [low + step, high + step];
    });
  }
  async reset() {
    if (!this.full) return;
    this.result.view.signal('zoom_px', null).signal('zoom_py', null);
    await this.result.view.runAsync();
  }
  key(event) {
    const moves = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.15],
                    ArrowDown: [0, -0.15] };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === '+' || event.key === '=') this.zoom(0.6);
    else if (event.key === '-') this.zoom(1 / 0.6);
    else if (event.key === '0') this.reset();
    else if (event.key in moves) this.move(...moves[event.key]);
    else return;
    event.preventDefault();
  }

  // --- Values and files.
  csv() {
    const titles = Object.values(this.drawn.columns);
    return csvText(titles, this.drawn.data.map(row => Object.fromEntries(
      Object.entries(this.drawn.columns).map(([field, title]) => [title, row[field]]))));
  }
  saveCsv() { download(fileName(this.title) + '.csv', this.csv(), 'text/csv'); }
  async saveSvg() {
    download(fileName(this.title) + '.svg', await this.result.view.toSVG(), 'image/svg+xml');
  }
  async savePng() {
    const address = await this.result.view.toImageURL('png', 2);
    download(fileName(this.title) + '.png', address, 'image/png');
  }
  toggleTable() {
    this.hasTable = !this.hasTable;
    this.tableButton.setAttribute('aria-pressed', String(this.hasTable));
    this.showTable();
  }
  showTable() {
    this.table.replaceChildren();
    if (!this.hasTable || !this.drawn?.spec) return;
    const columns = Object.entries(this.drawn.columns).map(([field, title]) => ({ field, title }));
    this.table.append(sortableTable(columns, this.drawn.data, { page: 25 }));
  }
}

// Names in legends, which may be cut, are whole under the mouse: Vega-Lite has no word for this that the
// legends of layers could share.
function withWholeNames(spec) {
  for (const legend of spec.legends ?? []) {
    const labels = (legend.encode ??= {}).labels ??= {};
    labels.interactive = true;
    labels.update = { ...labels.update, tooltip: { signal: labels.update?.text?.signal ?? 'datum.label' } };
  }
  return spec;
}

// --- Parts of specifications.
const axisOf = (field, title, isLog, extra = {}) => ({
  field, type: 'quantitative', title,
  scale: { ...(isLog ? { type: 'log', nice: false } : { zero: false }), ...extra.scale },
  axis: { format: isLog && field === 'py' ? '~e' : '.8~g' },
});
// The range of the data with some room; a single value has room around it too.
function domainAround(values, isLog) {
  const shown = isLog ? values.map(Math.log) : values;
  const [low, high] = shown.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
  const room = high > low ? 0.03 * (high - low) : isLog ? 0.7 : Math.max(1, Math.abs(low)) * 0.5;
  return [low - room, high + room].map(value => isLog ? Math.exp(value) : value);
}
// A text in lines that are at most so many pixels wide, unless a word is wider. No word ends it alone.
const ruler = document.createElement('canvas').getContext('2d');
function inLines(text, width) {
  ruler.font = `${kTitleSize}px ${kFont}`;
  const lines = [];
  for (const word of text.split(/ (?!\S+$)/)) {
    const longer = `${lines.at(-1)} ${word}`;
    if (lines.length > 0 && ruler.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines.join(kBreak);
}
// The names of both axes in lines no longer than the axes: the other axis with its numbers and its
// name takes some 70 pixels, and the legend its lines.
function withLines(x, y, { width, height, solvers }) {
  return { x: { ...x, title: inLines(x.title, width - 70) },
           y: { ...y, title: inLines(y.title, height - legendHeight(solvers, width) - 70) } };
}
function looksOf(solvers, channel, looks) {
  return { field: 'solver', type: 'nominal', title: null,
           scale: { domain: solvers, range: solvers.map(solver => lookOf(solver, looks)) } };
}
// So many names stand side by side, each behind its line: 7 pixels a letter. A name that is longer than
// its column is cut, and whole under the mouse.
const kLegendSymbol = 50;  // pixels before a name
const kWidestName = 400;
function legendColumns(solvers, width) {
  const longest = solvers.reduce((most, solver) => Math.max(most, solver.length), 0);
  return Math.max(1, Math.min(solvers.length, Math.floor(width / (kLegendSymbol + Math.min(kWidestName, 5 + 7 * longest)))));
}
const labelLimit = (solvers, width) => Math.floor(width / legendColumns(solvers, width)) - kLegendSymbol;
const legendHeight = (solvers, width) => 25 * Math.ceil(solvers.length / legendColumns(solvers, width));
function colours(solvers, width) {
  const columns = legendColumns(solvers, width);
  return { field: 'solver', type: 'nominal', title: null,
           scale: { domain: solvers, range: solvers.map(colourOf) },
           legend: { orient: 'bottom', columns, symbolType: 'stroke', symbolSize: 900,
                     labelLimit: labelLimit(solvers, width) } };
}
// Drag moves, Ctrl + wheel zooms: the wheel alone goes on scrolling the page.
const kZoom = { name: 'zoom', bind: 'scales',
                select: { type: 'interval', zoom: 'wheel![event.ctrlKey]', clear: 'dblclick' } };
const kHover = { name: 'hover', select: { type: 'point', on: 'pointerover', nearest: true,
                                          clear: 'pointerout' } };

// A click on a name in the legend leaves that solver's lines alone bright, another one all.
const kPick = { name: 'pick', select: { type: 'point', fields: ['solver'] }, bind: 'legend' };

// Lines of rows {solver, run, px, py, ...}, one per run; `mark` is the shape at one.
function lineSpec({ width, height, solvers, data, x, y, tooltip, interpolate = 'linear' }) {
  const shared = { ...withLines(x, y, { width, height, solvers }), color: colours(solvers, width) };
  const dash = { ...looksOf(solvers, 'strokeDash', kDashes) };
  const bright = { condition: { param: 'pick', value: 1 }, value: 0.12 };
  const marks = {
    transform: [{ filter: 'datum.mark' }],
    mark: { type: 'point', filled: true, size: 40, clip: true },
    encoding: { ...shared, opacity: bright, shape: { field: 'mark', type: 'nominal', scale: null } },
  };
  return {
    width, height, autosize: { type: 'fit', contains: 'padding' }, data: { name: 'rows' },
    layer: [
      { params: [kZoom, kPick], mark: { type: 'line', interpolate, clip: true, strokeWidth: 1.8,
                                        invalid: 'break-paths-filter-domains' },
        encoding: { ...shared, strokeDash: { ...dash, legend: shared.color.legend }, opacity: bright,
                    detail: { field: 'run' } } },
      // Vega warns of a layer without a row.
      ...(data.some(row => row.mark) ? [marks] : []),
      { params: [kHover], mark: { type: 'point', filled: true, size: 60, clip: true },
        encoding: { ...shared, tooltip,
                    opacity: { condition: { param: 'hover', empty: false, value: 1 }, value: 0 } } },
    ],
  };
}

// Dots of rows {solver, px, py, ...}.
function dotSpec({ width, height, solvers, x, y, tooltip }) {
  const color = colours(solvers, width);
  delete color.legend.symbolType;
  color.legend.symbolSize = 80;
  return {
    width, height, autosize: { type: 'fit', contains: 'padding' }, data: { name: 'rows' },
    params: [kZoom], mark: { type: 'point', filled: true, size: 55, opacity: 0.8, clip: true },
    encoding: { ...withLines(x, y, { width, height, solvers }), color, tooltip,
                shape: { ...looksOf(solvers, 'shape', kShapes), legend: color.legend } },
  };
}
const heightFor = (width, solvers) =>
  Math.round(Math.min(420, Math.max(280, width * 0.55)) + legendHeight(solvers, width));

// Some marks on each line of solvers beyond the first eight, those of different lines apart.
function putMarks(points) {
  const byRun = new Map();
  for (const point of points) {
    if (!isMarked(point.solver)) continue;
    if (!byRun.has(point.run)) byRun.set(point.run, []);
    byRun.get(point.run).push(point);
  }
  for (const line of byRun.values()) {
    const count = Math.min(4, line.length), shift = (allSolvers.indexOf(line[0].solver) % 8) / 8;
    const shape = lookOf(line[0].solver, kShapes);
    for (let k = 0; k < count; ++k) line[Math.floor((k + shift) * line.length / count)].mark = shape;
  }
}
