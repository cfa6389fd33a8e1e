// The player: the curves of all solvers on one problem, side by side, at one iteration.

const kMostPanels = 24;
const kSamplesPerSpan = 8;

// The control points of iterate k of a run.
function controlPoints(run, k) {
  const dimension = run.origin.length, flat = run.points[k], points = [];
  for (let i = 0; i < flat.length; i += dimension) {
    points.push(run.origin.map((origin, c) =>
      flat[i + c] === null ? NaN : origin + run.unit * flat[i + c]));
  }
  return points;
}
// The kept iterate that stands for an iteration: the last one not behind it.
const iterateAt = (run, iteration) =>
  Math.max(0, run.iterations.findLastIndex(kept => kept <= iteration));

// C(u) by de Boor's recursion (Piegl, Tiller, The NURBS Book, 1997); `knots` u, degree p.
function deBoor(knots, degree, points, span, u) {
  const d = [];
  for (let j = 0; j <= degree; ++j) d.push(points[(span - degree + j) % points.length]);
  for (let level = 1; level <= degree; ++level) {
    for (let j = degree; j >= level; --j) {
      const left = knots[span - degree + j], right = knots[span + 1 + j - level];
      const part = right > left ? (u - left) / (right - left) : 0;
      d[j] = d[j].map((value, c) => (1 - part) * d[j - 1][c] + part * value);
    }
  }
  return d[degree];
}
// Periodic: n control points, n + 2p + 1 knots, domain [u_p, u_(n+p)]; open: [u_p, u_n].
function curvePoints(setting, points) {
  const { degree, knots, periodic } = setting, sampled = [];
  const end = periodic ? points.length + degree : points.length;
  for (let span = degree; span < end; ++span) {
    if (!(knots[span + 1] > knots[span])) continue;
    const samples = degree === 1 ? 1 : kSamplesPerSpan;
    for (let s = 0; s < samples; ++s) {
      const u = knots[span] + (knots[span + 1] - knots[span]) * s / samples;
      sampled.push(deBoor(knots, degree, points, span, u));
    }
    if (span + 1 === end) sampled.push(deBoor(knots, degree, points, span, knots[end]));
  }
  return sampled;
}

// The spline and the data points of a run; undefined where the folder has no curves/NAME.json.
const settingOf = row => curves().problems[curves().runs[row.key].curve];

function playerRows(row, iteration, hasPolygon) {
  const run = curves().runs[row.key], setting = settingOf(row);
  const k = iterateAt(run, iteration);
  const control = controlPoints(run, k);
  const panel = row.panel, at = run.iterations[k];
  const list = (kind, points) => points.map((point, order) => ({
    panel, solver: row.solver, kind, order, iteration: at, px: point[0], py: point[1] ?? 0 }))
    .filter(point => isNumber(point.px) && isNumber(point.py));
  const closed = setting?.periodic ? [...control, control[0]] : control;
  return [...(setting ? list('point', setting.points) : []),
          ...(hasPolygon || !setting ? list('polygon', closed) : []),
          ...(setting ? list('curve', curvePoints(setting, control)) : [])];
}

function boxOf(points) {
  const side = c => [Math.min(...points.map(p => p[c])), Math.max(...points.map(p => p[c]))];
  const [x, y] = [side(0), side(1)];
  const margin = 0.12 * Math.max(x[1] - x[0], y[1] - y[0], 1e-300);
  return { x: [x[0] - margin, x[1] + margin], y: [y[0] - margin, y[1] + margin] };
}

function playerSpec(width, panels, box) {
  const columns = Math.max(1, Math.min(panels.length, Math.floor(width / 230)));
  const panelWidth = Math.floor(width / columns) - 14;
  const aspect = (box.y[1] - box.y[0]) / (box.x[1] - box.x[0]);
  const height = Math.round(Math.min(2 * panelWidth, Math.max(0.3 * panelWidth, panelWidth * aspect)));
  const solvers = allSolvers.filter(solver => panels.some(row => row.solver === solver));
  const position = {
    x: { field: 'px', type: 'quantitative', axis: null, scale: { domain: box.x, nice: false, zero: false } },
    y: { field: 'py', type: 'quantitative', axis: null, scale: { domain: box.y, nice: false, zero: false } },
  };
  const color = { field: 'solver', type: 'nominal', legend: null,
                  scale: { domain: solvers, range: solvers.map(colourOf) } };
  const grey = scheme === 'dark' ? '#8d96a0' : '#6b737c';
  const tooltip = ['solver', 'kind', 'order', 'iteration'].map(field => ({ field }))
    .concat([{ field: 'px', title: 'x (unit of the data)', format: '.5~g' },
             { field: 'py', title: 'y (unit of the data)', format: '.5~g' }]);
  const only = kind => [{ filter: { field: 'kind', equal: kind } }];
  return {
    data: { name: 'rows' }, columns, spacing: { row: 6, column: 8 },
    facet: { field: 'panel', type: 'nominal', sort: panels.map(row => row.panel), title: null,
             header: { labelLimit: panelWidth } },
    spec: { width: panelWidth, height, layer: [
      { transform: only('polygon'), mark: { type: 'line', strokeWidth: 0.7, color: grey, clip: true },
        encoding: { ...position, order: { field: 'order' }, detail: { field: 'panel' } } },
      { transform: only('curve'), mark: { type: 'line', strokeWidth: 2, clip: true },
        encoding: { ...position, color, order: { field: 'order' }, detail: { field: 'panel' } } },
      { transform: only('point'), mark: { type: 'point', filled: true, size: 12, color: grey, clip: true },
        encoding: { ...position, tooltip } },
      { transform: only('polygon'), mark: { type: 'point', size: 14, color: grey, clip: true },
        encoding: { ...position, tooltip } },
    ] },
  };
}

class Player {
  constructor(groups) {
    this.state = { group: undefined, iteration: 0, polygon: false, zoom: 1, x: 0, y: 0 };
    this.timer = null;
    this.plot = new Plot('Curves side by side', width => this.build(width));
    this.plot.setDomains = () => Promise.resolve();
    this.plot.zoom = factor => this.view(this.state.zoom * factor, 0, 0);
    this.plot.move = (x, y) => this.view(this.state.zoom, x, y);
    this.plot.reset = () => this.view(1, -this.state.x / this.state.zoom, -this.state.y / this.state.zoom);
    this.slider = element('input', { type: 'range', min: 0, max: 1, step: 1, 'aria-label': 'Iteration',
                                     oninput: () => this.show(Number(this.slider.value)) });
    this.label = element('output', {});
    this.playButton = this.button('Play', () => this.togglePlay());
    this.choice = groupChoice(groups, group => { this.state.group = group; this.restart(); });
    this.none = element('p', { class: 'none' }, 'No run that passes the filters has kept its iterates.');
    this.shown = element('div', {},
      element('div', { class: 'row' }, this.choice.label,
        check('Control polygons', false, on => { this.state.polygon = on; this.plot.refresh(); })),
      element('div', { class: 'row' }, this.button('First', () => this.show(0)),
        this.button('Back', () => this.step(-1)), this.playButton,
        this.button('Next', () => this.step(1)), this.button('Last', () => this.show(this.last())),
        this.slider, this.label),
      this.plot.figure);
    this.node = element('div', {}, this.none, this.shown);
  }
  // Offers the problems of which a run passes the filters, and shows another where the shown one is gone.
  follow() {
    const passing = new Set(chosen.filter(row => row.key in curves().runs).map(row => row.group));
    this.state.group = this.choice.offer(passing);
    this.none.hidden = passing.size > 0;
    this.shown.hidden = passing.size === 0;
    this.restart();
  }
  button(text, onclick) { return element('button', { type: 'button', onclick }, text); }

  runs() {
    return chosen.filter(row => row.group === this.state.group && row.key in curves().runs);
  }
  // The iterations that some run that is shown has kept: the player stops at these.
  stops() {
    return [...new Set(this.panels().flatMap(row => curves().runs[row.key].iterations))]
      .sort((a, b) => a - b);
  }
  last() { return this.stops().at(-1) ?? 0; }
  step(way) {
    const stops = this.stops(), now = this.state.iteration;
    const next = way > 0 ? stops.find(stop => stop > now) : stops.findLast(stop => stop < now);
    if (next === undefined) return false;
    this.show(next);
    return true;
  }
  togglePlay() {
    if (this.timer === null && this.state.iteration >= this.last()) this.show(0);
    const stop = () => { clearInterval(this.timer); this.timer = null; };
    if (this.timer !== null) stop();
    else this.timer = setInterval(() => { if (!this.step(1)) { stop(); this.word(); } }, 350);
    this.word();
  }
  word() { this.playButton.textContent = this.timer === null ? 'Play' : 'Pause'; }
  restart() {
    this.slider.max = String(this.last());
    this.show(0);
    this.plot.refresh();
  }
  view(zoom, x, y) {
    Object.assign(this.state, { zoom, x: this.state.x + x * zoom, y: this.state.y + y * zoom });
    this.plot.refresh();
    return this.plot.isDone;
  }
  // New data in the plot that stands, not a new plot.
  show(iteration) {
    this.state.iteration = iteration;
    this.slider.value = String(iteration);
    this.label.textContent = `iteration ${iteration} of ${this.last()}`;
    if (!this.plot.result) return;
    this.plot.drawn.data = this.rows();
    this.plot.result.view.data('rows', this.plot.drawn.data).runAsync();
  }
  panels() {
    const list = this.runs().slice(0, kMostPanels), seen = new Map();
    return list.map(row => {
      const number = (seen.get(row.solver) ?? 0) + 1;
      seen.set(row.solver, number);
      return { ...row, panel: number === 1 ? row.solver : `${row.solver} (run ${number})` };
    });
  }
  rows() {
    return this.panels().flatMap(row => playerRows(row, this.state.iteration, this.state.polygon));
  }
  build(width) {
    const all = this.runs(), panels = this.panels();
    if (panels.length === 0) return { caption: this.none.textContent };
    const setting = settingOf(panels[0]);
    const caption = (setting ? 'Curve and data points (dots)' : 'Control polygon (the folder has no ' +
      'curves/NAME.json to draw the curve by)') +
      ' of each run at the chosen iteration, or at the last one before it that the page has; a run ' +
      'that has ended stays at its end. Coordinates are rounded to 1e-4 of the size of the start. ' +
      (setting && setting.num_points > setting.points.length
        ? `${setting.points.length} of ${setting.num_points} data points are drawn. ` : '') +
      'The first two coordinates are drawn.' +
      excludedText([[all.length - panels.length, `beyond the first ${kMostPanels}: use the filters`]]);
    const box = this.zoomed(boxOf(setting ? setting.points
      : controlPoints(curves().runs[panels[0].key], 0)));
    return { caption, data: this.rows(), spec: playerSpec(width, panels, box), zooms: false,
             columns: { solver: 'solver', panel: 'run', iteration: 'iteration', kind: 'kind',
                        order: 'order', px: 'x (unit of the data)', py: 'y (unit of the data)' } };
  }
  zoomed(box) {
    const { zoom, x, y } = this.state;
    const side = ([low, high], shift) => {
      const middle = (low + high) / 2 + shift * (high - low), half = (high - low) / 2 * zoom;
      return [middle - half, middle + half];
    };
    return { x: side(box.x, x), y: side(box.y, y) };
  }
}

function addPlayer() {
  const groups = [...new Set(rows.filter(row => row.key in curves().runs).map(row => row.group))];
  if (groups.length === 0) {
    addSection('Player', element('p', {}, 'The folder has no iterates (iterates/KEY.jsonl); batten ' +
      'compare keeps them with --keep_iterates=40, batten bench unless "keep_iterates" of its suite is 0.'));
    return;
  }
  const player = new Player(groups);
  addRunSection('Player', player.node, () => player.follow());
}
