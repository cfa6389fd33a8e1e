// The figures of the folder whose panels it has as numbers (STEM.plot.json): each panel is a plot.

const panelsOf = later('plots-data');  // by stem

// The colours of the pictures (experiments/plot.cc) by their numbers, darkened or lightened for the two schemes.
const kPanelPalettes = {
  light: ['#0072b2', '#d55e00', '#009e73', '#c2589a', '#4aa3df', '#a67c00', '#1c1f23', '#6f7780'],
  dark: ['#4fa8e0', '#ff8a3d', '#2ec79a', '#e69ac4', '#a9dcff', '#e6c229', '#f2f4f6', '#9aa2ab'],
};
const kPanelStyles = {
  line: { line: true }, dashed: { line: true }, one_of_many: { line: true },
  line_points: { line: true, dot: true }, points: { dot: true }, circles: { ring: true },
};
const groupOfColor = color => Math.floor(color / 8) % kDashes.length;

// A line of many that is a solver's looks as in all other plots of the page.
function lookOfLine({ style, label, color }) {
  if (style === 'one_of_many' && allSolvers.includes(label)) {
    return { colour: colourOf(label), dash: lookOf(label, kDashes), shape: lookOf(label, kShapes), isMarked: isMarked(label) };
  }
  return { colour: kPanelPalettes[scheme][((color % 8) + 8) % 8],
           dash: style === 'dashed' ? [6, 4] : style === 'one_of_many' ? kDashes[groupOfColor(color)] : [1, 0],
           shape: kShapes[groupOfColor(color)], isMarked: groupOfColor(color) > 0 };
}
// Series by their place: names may be empty or stand twice.
function looksOfSeries(panel) {
  return panel.series.map((series, k) => ({
    id: String(k), style: series.style, name: series.label || `line ${k + 1}`, isNamed: series.label !== '',
    ...lookOfLine(series), ...kPanelStyles[series.style],
  }));
}

// What the axes can show, in the order of the lines.
function panelRows(panel, looks) {
  const isShown = (value, isLog) => isNumber(value) && (!isLog || value > 0);
  const nameAt = x => panel.x_names.length === 0 ? x : panel.x_names[x - 1] ?? x;
  const points = (series, k, xs, ys) => xs.flatMap((px, order) =>
    isShown(px, panel.log_x) && isShown(ys[order], panel.log_y)
      ? [{ id: String(k), series: looks[k].name, style: series.style, order, at: nameAt(px), px, py: ys[order] }] : []);
  return {
    data: panel.series.flatMap((series, k) => points(series, k, series.x, series.y)),
    marks: panel.series.flatMap((series, k) => series.style !== 'one_of_many' || !looks[k].isMarked ? []
      : points(series, k, series.mark_x ?? [], series.mark_y ?? []).map(point => ({ ...point, shape: looks[k].shape }))),
  };
}

// Width and height of a panel, and its domains: with equal scale a unit is as many pixels on both.
function panelSize(panel, data, width) {
  const x = panel.x_names.length > 0 ? [0.5, panel.x_names.length + 0.5]
    : domainAround(data.map(row => row.px), panel.log_x);
  const y = panel.is_share ? [0, 1.03] : domainAround(data.map(row => row.py), panel.log_y);
  if (!panel.equal_scale) {
    const turned = areNamesCrowded(panel.x_names, width) ? 80 : 0;
    return { x, y, width, height: Math.round(Math.min(340, Math.max(260, width * 0.55))) + turned };
  }
  const inner = width - 75, wide = x[1] - x[0], high = y[1] - y[0];
  const height = Math.round(Math.min(420, Math.max(140, inner * high / wide)));
  const unit = Math.max(wide / inner, high / height);  // of the data, in a pixel
  const around = ([low, high], pixels) => [-0.5, 0.5].map(part => (low + high) / 2 + part * unit * pixels);
  return { x: around(x, inner), y: around(y, height), width: inner, height };
}

const areNamesCrowded = (names, width) =>
  names.length > 0 && 8 * Math.max(...names.map(name => name.length)) * names.length > width - 70;
function panelAxes(panel, size, names) {
  const axis = (field, title, isLog, domain, lines) => ({
    field, type: 'quantitative', title: title === '' ? null : inLines(title, lines),
    scale: { domain, nice: false, ...(isLog ? { type: 'log' } : { zero: false }) },
    axis: { format: '.8~g', tickCount: isLog ? 5 : 6, labelSeparation: 6 },
  });
  const x = axis('px', panel.x_label, panel.log_x, size.x, size.width - 70);
  const y = axis('py', panel.y_label, panel.log_y, size.y, size.height - 40);
  if (names.length > 0) {
    x.axis = { values: names.map((_, k) => k + 1), labelExpr: `${JSON.stringify(names)}[datum.value - 1]`,
               labelAngle: areNamesCrowded(names, size.width) ? -50 : 0, labelLimit: 130, labelOverlap: false, grid: false };
  }
  return { x, y };
}

// In boxes from -1 to 1, 30 pixels wide; one size for all, since Vega takes it for the room before the names.
const kLinePath = 'M-1,0L1,0';
const circlePath = (radius, way = 0) =>
  `M${-radius},0A${radius},${radius},0,1,${way},${radius},0A${radius},${radius},0,1,${way},${-radius},0`;
const [kDotPath, kRingPath] = [circlePath(0.15), circlePath(0.4) + circlePath(0.3, 1)];  // both are filled
// A symbol for each series that has a name: its line, its disc or its ring.
function panelLegend(panel, looks, width) {
  const named = looks.filter(look => look.isNamed);
  if (!panel.legend || named.length === 0) return null;
  const per = value => ({ value: { signal: `${JSON.stringify(looks.map(value))}[datum.value]` } });
  return {
    orient: 'bottom', columns: legendColumns(named.map(look => look.name), width), values: named.map(look => look.id),
    symbolSize: 900, labelLimit: labelLimit(named.map(look => look.name), width),
    labelExpr: `${JSON.stringify(looks.map(look => look.name))}[datum.value]`,
    encoding: { symbols: {
      shape: per(look => (look.line ? kLinePath : '') + (look.dot ? kDotPath : look.ring ? kRingPath : '')),
      stroke: per(look => look.colour), fill: per(look => look.colour),
      strokeDash: per(look => look.dash), strokeWidth: { value: 1.5 }, opacity: { value: 1 } } },
  };
}

function panelSpec(panel, looks, { data, marks }, width) {
  const size = panelSize(panel, data, width), ids = looks.map(look => look.id);
  const legend = panelLegend(panel, looks, size.width);
  const color = { field: 'id', type: 'nominal', title: null, scale: { domain: ids, range: looks.map(look => look.colour) },
                  ...(legend ? {} : { legend }) };
  const shared = { ...panelAxes(panel, size, panel.x_names), color };
  const bright = legend ? { condition: { param: 'pick', value: 1 }, value: 0.12 } : { value: 1 };
  const layer = (some, mark, encoding = {}) => ({
    transform: [{ filter: { field: 'id', oneOf: some.map(look => look.id) } }], mark: { clip: true, ...mark },
    encoding: { ...shared, opacity: bright, ...encoding } });
  const circle = { type: 'point', shape: 'circle' }, order = { field: 'order', type: 'quantitative' };
  const kindsOf = look => [look.dot && 'dot', look.ring && 'ring', look.line && `line ${look.dash}`].filter(Boolean);
  const layerOf = kind => {
    const some = looks.filter(look => kindsOf(look).includes(kind) && data.some(row => row.id === look.id));
    return some.length === 0 ? []
      : kind === 'dot' ? [layer(some, { ...circle, filled: true, size: 20 })]
      : kind === 'ring' ? [layer(some, { ...circle, filled: false, size: 70 })]
      : [layer(some, { type: 'line', strokeWidth: 1.8, strokeDash: some[0].dash }, { order })];
  };
  // As in the picture: what comes first is below.
  const drawn = inOrder(looks.flatMap(kindsOf)).flatMap(layerOf);
  const extra = marks.length === 0 ? [] : [{
    data: { name: 'marks' }, mark: { type: 'point', filled: true, size: 40, clip: true },
    encoding: { ...shared, opacity: bright, shape: { field: 'shape', type: 'nominal', scale: null } } }];
  const [along, up] = [panel.x_label || 'along', panel.y_label || 'up'];
  const hover = {
    params: [kZoom, kHover, ...(legend ? [{ name: 'pick', select: { type: 'point', fields: ['id'] }, bind: 'legend' }] : [])],
    mark: { type: 'point', filled: true, size: 60, clip: true },
    encoding: { ...shared, color: { ...color, legend }, opacity: { condition: { param: 'hover', empty: false, value: 1 }, value: 0 },
                tooltip: [{ field: 'series', title: 'line' },
                          panel.x_names.length > 0 ? { field: 'at', title: along }
                                                   : { field: 'px', title: along, format: '.5~g' },
                          { field: 'py', title: up === along ? `${up} (up)` : up, format: '.5~g' }] },
  };
  const names = looks.filter(look => look.isNamed).map(look => look.name);
  const below = legend && !panel.equal_scale ? legendHeight(names, size.width) : 0;  // else it is not in the height
  return {
    width: size.width, height: size.height + below,
    autosize: panel.equal_scale ? { type: 'pad' } : { type: 'fit', contains: 'padding' },
    data: { name: 'rows' }, layer: [...drawn, ...extra, hover],
  };
}

function panelPlot(stem, place, title) {
  return new Plot(title, width => {
    const panel = panelsOf()[stem][place], looks = looksOfSeries(panel);
    const rows = panelRows(panel, looks);
    const sum = field => panel.series.reduce((total, series) => total + field(series), 0);
    const kept = sum(series => series.x.length), all = sum(series => series.num_points);
    const lost = kept - rows.data.length;
    const caption = [
      `Panel ${place + 1} of ${panelsOf()[stem].length} of ${stem}: ` +
        (panel.x_label || panel.y_label ? `${panel.y_label || 'up'} against ${panel.x_label || 'along'}, ` : 'in the plane, ') +
        `${counted(panel.series.length, 'line')} of ${counted(rows.data.length, 'point')}.`,
      panel.equal_scale ? 'One unit is as long on both axes.' : '',
      all > kept ? `Thinned from ${counted(all, 'point')}: the data of the picture has them all.` : '',
      lost > 0 ? `${counted(lost, 'point')} that the axes cannot show, left out.` : ''].filter(Boolean).join(' ');
    if (rows.data.length === 0) return { caption };
    return { caption, data: rows.data, more: rows.marks.length > 0 ? { marks: rows.marks } : {}, zooms: true,
             logs: { px: panel.log_x, py: panel.log_y },
             columns: { series: 'line', at: panel.x_label || 'along',
                        py: panel.y_label === panel.x_label ? `${panel.y_label} up` : panel.y_label || 'up' },
             spec: panelSpec(panel, looks, rows, width) };
  });
}

// The panels of one figure, its caption, and the picture as gnuplot drew it to download.
function panelFigure(picture, caption) {
  const stem = picture.name.replace(/\.svg$/, '');
  const titles = picture.panels.map(title => title === '' ? stem : `${stem}: ${title}`);
  const isTwice = title => titles.filter(other => other === title).length > 1;
  const plots = titles.map((title, k) => panelPlot(stem, k, isTwice(title) ? `${title} (${k + 1})` : title));
  const save = (text, ending, content, type) => content === undefined ? null
    : element('button', { type: 'button', onclick: () => download(stem + ending, content, type) }, text);
  return element('div', { class: 'panels' }, element('p', {}, caption),
    element('div', { class: 'row' }, save(`${stem}.svg, as gnuplot drew it`, '.svg', picture.svg, 'image/svg+xml'),
      save(`${stem}.dat, what it plots`, '.dat', picture.data, 'text/plain')),
    element('div', { class: 'plots' }, ...plots.map(plot => plot.figure)));
}
const figureOf = (picture, caption) =>
  picture.panels ? panelFigure(picture, caption) : pictureOf(picture, caption);
