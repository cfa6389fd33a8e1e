// The plots that are computed from the runs that pass the filters.

// `name` is that of the choice and in captions, `column` the place in a trace (docs/report.md).
const kAlong = {
  iteration: { name: 'iterations', title: 'iteration', column: 1 },
  evaluations: { name: 'evaluations', title: 'evaluations of E, gradient and Jacobian, products', column: 2,
                 note: ' Evaluations are calls of E, its gradient and Jacobian, and products.' },
  work_units: { name: 'work units', title: 'work units (times of one evaluation of E)', column: 3, isTime: true,
                note: ' A work unit is the wall time of one evaluation of E on the same instance.' },
  seconds: { name: 'wall time', title: 'wall time of the solver (s)', column: 3, isTime: true },
  cpu_seconds: { name: 'processor time', title: 'processor time of the solver (s)', column: 4, isTime: true },
};
const measures = Object.keys(kAlong).filter(measure => measure !== 'work_units' || hasWorkUnits)
  .map(measure => [measure, kAlong[measure].name]);
// Seconds in the unit of the measure; 1 for what is no time. null: that unit was not measured.
const unitOf = (row, measure) => measure === 'work_units' ? doc.groups[row.group].unit_seconds ?? null : 1;
// The runs whose costs can be shown, and why others are left out.
function withCosts(list, measure) {
  const known = list.filter(row => unitOf(row, measure) !== null);
  const timed = kAlong[measure].isTime ? known.filter(row => !isOverlapped(row)) : known;
  return { timed, left: [[known.length - timed.length, 'timed while other runs went on (overlapped)'],
                         [list.length - known.length, 'where no evaluation of E was timed']] };
}
const kUp = {
  gap: { title: 'gap (E − E*) / (E(start) − E*), no unit', log: true },
  excess: { title: 'E − E* (unit of the data, squared)', log: true },
  energy: { title: 'E (unit of the data, squared)', log: true },
  gradient: { title: '|g| (unit of the data)', log: true },
};
const kMostLines = 150;

const nameOf = measure => kAlong[measure].name;
const noteOf = measure => kAlong[measure].note ?? '';
const traceOf = row => (row.key ? traces()[row.key] : undefined);

function excludedText(parts) {
  const said = parts.filter(([number]) => number > 0).map(([number, text]) =>
    `${counted(number, 'run')} ${text}`);
  return said.length === 0 ? ' No run is left out.' : ` Left out: ${said.join('; ')}.`;
}

// --- Convergence: one problem at a time.
function convergencePlot(settings) {
  return new Plot('Convergence', width => {
    const along = kAlong[settings.along], up = kUp[settings.up];
    const all = chosen.filter(row => row.group === settings.group);
    if (all.length === 0) return { caption: 'No run of this problem passes the filters.' };
    const group = doc.groups[settings.group] ?? {};
    const withTrace = all.filter(traceOf);
    const { timed, left } = withCosts(withTrace, settings.along);
    const drawn = timed.slice(0, kMostLines);
    const data = drawn.flatMap((row, run) => convergenceRows(row, run, settings, group));
    const atEdge = settings.logX && putStartsAtEdge(data);
    putMarks(data);
    const solvers = allSolvers.filter(solver => drawn.some(row => row.solver === solver));
    const star = group.direct ? 'of the direct answer'
      : group.basins ? 'the best minimum that some run from this start leads to'
      : 'the lowest that any run of the folder saw';
    const caption = `${up.title} against ${along.title}, each run of ${groupName(settings.group)} a line. ` +
      `E* = ${show(group.minimum, 8)}, ${star}. ` +
      'Traces are thinned to 64 rows a run.' + noteOf(settings.along) +
      (atEdge ? ' What is at 0 along is drawn at the left edge.' : '') +
      (['gap', 'excess'].includes(settings.up)
        ? ' Where E − E* is below the rounding of E, that is drawn.' : '') +
      excludedText([
        [all.length - withTrace.length, 'without a trace (skipped, crashed, or none was kept)'],
        ...left, [timed.length - drawn.length, `beyond the first ${kMostLines}: use the filters`]]);
    if (data.length === 0) return { caption };
    const logX = settings.logX;
    const x = axisOf('px', along.title, logX), y = axisOf('py', up.title, up.log);
    return {
      caption, data, zooms: true, logs: { px: logX, py: up.log },
      columns: { problem: 'problem', solver: 'solver', key: 'key', iteration: 'iteration',
                 ...(settings.along === 'iteration' ? {} : { at: along.title }), py: up.title },
      spec: lineSpec({ width, height: heightFor(width, solvers), solvers, data, x, y, tooltip: [
        { field: 'solver', title: 'solver' }, { field: 'label', title: 'run' },
        { field: 'iteration', title: 'iteration' },
        ...(settings.along === 'iteration' ? [] : [{ field: 'at', title: along.title, format: '.5~g' }]),
        { field: 'py', title: up.title, format: '.5~g' }] }),
    };
  });
}

function convergenceRows(row, run, settings, group) {
  const [, iterations, , , , excess, gradients] = traceOf(row);
  const unit = unitOf(row, settings.along);
  const xs = traceOf(row)[kAlong[settings.along].column].map(value => value === null ? null : value / unit);
  const first = excess[0];
  const label = [row.key, isNumber(row.repetition) ? `repetition ${row.repetition}` : null,
                 isNumber(row.start_seed) ? `start ${row.start_seed}` : null]
    .filter(Boolean).join(', ');
  const rounding = 2 ** -52 * Math.abs(group.minimum);
  const up = { gap: k => Math.max(excess[k], rounding) / first,
               excess: k => isNumber(excess[k]) ? Math.max(excess[k], rounding) : null,
               energy: k => excess[k] + group.minimum, gradient: k => gradients[k] }[settings.up];
  const points = [];
  for (let k = 0; k < iterations.length; ++k) {
    const px = xs[k], py = excess[k] === null ? null : up(k);
    if (!isNumber(px) || !isNumber(py) || px < 0 || py <= 0) continue;
    points.push({ problem: row.problem, solver: row.solver, key: row.key ?? '', run, label,
                  iteration: iterations[k], at: px, px, py });
  }
  return points;
}

// A logarithmic axis has no 0: half the smallest value beyond it stands for it; `at` stays 0.
function putStartsAtEdge(points) {
  const least = points.reduce((min, point) => point.px > 0 ? Math.min(min, point.px) : min, Infinity);
  const atZero = points.filter(point => point.px === 0);
  for (const point of atZero) point.px = Number.isFinite(least) ? least / 2 : 0.5;
  return atZero.length > 0;
}

// --- Where runs end.
function endPlot(settings) {
  return new Plot('Where the runs end', width => {
    const along = kAlong[settings.along];
    const cost = settings.along === 'iteration' ? 'iterations' : settings.along;
    const ran = chosen.filter(row => row.verdict !== 'skipped');
    const { timed, left } = withCosts(ran, settings.along);
    if (chosen.length === 0) return { caption: 'No run passes the filters.' };
    const data = timed.map(row => ({ ...pick(row, ['problem', 'solver', 'stop', 'key']),
                                     px: row[cost], py: row.gradient_norm / row.start_gradient_norm }))
      .filter(row => row.px > 0 && row.py > 0 && isNumber(row.px) && isNumber(row.py));
    const solvers = allSolvers.filter(solver => data.some(row => row.solver === solver));
    const title = '|g| at the end over |g| at the start, no unit';
    const caption = `${title}, against ${along.title}: each run a mark.` + noteOf(settings.along) +
      excludedText([[chosen.length - ran.length, 'skipped'],
                    ...left,
                    [timed.length - data.length, 'without these numbers, or with 0']]);
    if (data.length === 0) return { caption };
    return {
      caption, data, zooms: true, logs: { px: true, py: true },
      columns: { problem: 'problem', solver: 'solver', key: 'key', stop: 'stop', px: along.title,
                 py: title },
      spec: dotSpec({ width, height: heightFor(width, solvers), solvers,
                      x: axisOf('px', along.title, true, { scale: { domain: domainAround(data.map(row => row.px), true) } }),
                      y: axisOf('py', title, true, { scale: { domain: domainAround(data.map(row => row.py), true) } }),
                      tooltip: [{ field: 'problem', title: 'problem' },
                                { field: 'solver', title: 'solver' },
                                { field: 'stop', title: 'stop' },
                                { field: 'px', title: along.title, format: '.5~g' },
                                { field: 'py', title, format: '.3~g' }] }),
    };
  });
}
const pick = (row, fields) => Object.fromEntries(fields.map(field => [field, row[field] ?? '']));
