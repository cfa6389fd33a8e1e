// The plots that are computed from the runs that pass the filters.

const kAlong = {
  iteration: { title: 'iteration', many: 'iterations', column: 1 },
  evaluations: { title: 'evaluations of E, gradient and Jacobian, products', column: 2 },
  seconds: { title: 'wall time of the solver (s)', column: 3, isTime: true },
  cpu_seconds: { title: 'processor time of the solver (s)', column: 4, isTime: true },
};
const kUp = {
  gap: { title: 'gap (E − E*) / (E(start) − E*), no unit', log: true },
  excess: { title: 'E − E* (unit of the data, squared)', log: true },
  energy: { title: 'E (unit of the data, squared)', log: true },
  gradient: { title: '|g| (unit of the data)', log: true },
};
const kMostLines = 150;

const manyOf = measure => kAlong[measure].many ?? kAlong[measure].title;
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
    const group = doc.groups[settings.group] ?? {};
    const withTrace = all.filter(traceOf);
    const timed = withTrace.filter(row => !(along.isTime && isOverlapped(row)));
    const drawn = timed.slice(0, kMostLines);
    const data = drawn.flatMap((row, run) => convergenceRows(row, run, along, settings, group));
    const atEdge = settings.logX && putStartsAtEdge(data);
    putMarks(data);
    const solvers = allSolvers.filter(solver => drawn.some(row => row.solver === solver));
    const star = group.direct ? 'of the direct answer'
      : group.basins ? 'the best minimum that some run from this start leads to'
      : 'the lowest that any run of the folder saw';
    const caption = `${up.title} against ${along.title}, each run of ` +
      `${all.length > 0 ? groupName(settings.group) : 'no problem'} a line. ` +
      `E* = ${show(group.minimum, 8)}, ${star}. ` +
      'Traces are thinned to 64 rows a run.' +
      (atEdge ? ' What is at 0 along is drawn at the left edge.' : '') +
      (['gap', 'excess'].includes(settings.up)
        ? ' Where E − E* is below the rounding of E, that is drawn.' : '') +
      excludedText([
        [all.length - withTrace.length, 'without a trace (skipped, crashed, or none was kept)'],
        [withTrace.length - timed.length, 'timed while other runs went on (overlapped)'],
        [timed.length - drawn.length, `beyond the first ${kMostLines}: use the filters`]]);
    if (data.length === 0) return { caption };
    const logX = settings.logX;
    const x = axisOf('px', along.title, logX), y = axisOf('py', up.title, up.log);
    return {
      caption, data, zooms: true, logs: { px: logX, py: up.log },
      columns: { problem: 'problem', solver: 'solver', key: 'key', iteration: 'iteration',
                 px: along.title, py: up.title },
      spec: lineSpec({ width, height: heightFor(width, solvers), solvers, data, x, y, tooltip: [
        { field: 'solver', title: 'solver' }, { field: 'label', title: 'run' },
        { field: 'iteration', title: 'iteration' },
        { field: 'px', title: along.title, format: '.5~g' },
        { field: 'py', title: up.title, format: '.5~g' }] }),
    };
  });
}

function convergenceRows(row, run, along, settings, group) {
  const [, iterations, , , , excess, gradients] = traceOf(row);
  const xs = traceOf(row)[along.column];
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
                  iteration: iterations[k], px, py });
  }
  return points;
}

// A logarithmic axis has no 0: half the smallest value beyond it stands for it.
function putStartsAtEdge(points) {
  const least = points.reduce((min, point) => point.px > 0 ? Math.min(min, point.px) : min, Infinity);
  const atZero = points.filter(point => point.px === 0);
  for (const point of atZero) point.px = Number.isFinite(least) ? least / 2 : 0.5;
  return atZero.length > 0;
}

// --- How much a run needs to a target, which E* and the whole trace have decided.
// Infinity: it does not come there. null: there is nothing to tell it by. `own`: gaps are to the
// minimum of the basin that the run itself ends in, where the folder tells which.
function costOf(row, target, measure, own) {
  if (target === 'stop') {
    const value = row[measure === 'iteration' ? 'iterations' : measure];
    return row.verdict !== 'reached' ? Infinity : isNumber(value) ? value : null;
  }
  if (row.verdict === 'refuted') return Infinity;
  const trace = traceOf(row);
  if (!trace) return Infinity;
  const hits = ((own && trace[8]) || trace[7])[kAlong[measure].column - 1];
  return isNumber(hits[kTargets.indexOf(target)]) ? hits[kTargets.indexOf(target)] : Infinity;
}

// Fits with fixed, free and projected parameters are different problems.
const kindOfGroup = doc.groups.map((_, group) =>
  String(rows.find(row => row.group === group && row.parameter_kind)?.parameter_kind ?? ''));
const kindOf = row => kindOfGroup[row.group];  // skipped runs do not say it
const allKinds = inOrder(rows.map(kindOf));
const hasBasins = kind => rows.some(row => kindOf(row) === kind && traceOf(row)?.[8]);

// The instances of one kind of parameters with the runs of the solvers that apply to one of them;
// those that were timed beside others not by time.
function instances(measure, kind) {
  const here = chosen.filter(row => kindOf(row) === kind);
  const applying = new Set(here.filter(row => row.verdict !== 'skipped').map(row => row.solver));
  const runs = here.filter(row => applying.has(row.solver));
  const list = kAlong[measure].isTime ? runs.filter(row => !isOverlapped(row)) : runs;
  const byInstance = new Map();
  for (const row of list) {
    if (!byInstance.has(row.instanceId)) byInstance.set(row.instanceId, new Map());
    byInstance.get(row.instanceId).set(row.solver, row);
  }
  return { list: [...byInstance.values()], numOverlapped: runs.length - list.length };
}
function profileTitle(what, kind, own) {
  return [what, kind && `${kind} parameters`, hasBasins(kind) && (own ? 'own basin' : 'best basin')]
    .filter(Boolean).join(', ');
}
const basinText = own => own
  ? ' Gaps are to the minimum of the basin that a run itself ends in: a fast way to a worse minimum counts.'
  : '';
const solversOf = list =>
  allSolvers.filter(solver => list.some(runs => runs.has(solver)));
const failureText = runs => {
  const count = verdict => runs.filter(row => row.verdict === verdict).length;
  return `Charged as never solved: ${count('failed')} that failed or hit a limit, ` +
    `${count('refuted')} refuted by the audit or the direct answer, ` +
    `${count('skipped')} skipped since the solver does not apply, where they miss the target.`;
};
const targetText = target =>
  target === 'stop' ? 'what the run was asked for (its stop rule)' : `a gap of ${target.toExponential()}`;

// Dolan, More, Benchmarking optimization software with performance profiles, 2002:
// rho_s(tau) = share of instances that s solves within tau times the cost of the best solver.
function profilePlot(settings, kind, own) {
  return new Plot(profileTitle('Performance profile', kind, own), width => {
    const { measure, target } = settings;
    if (own && target === 'stop') {
      return { caption: 'What a run is asked for is the same in all basins: see the plot to the best one.' };
    }
    const { list, numOverlapped } = instances(measure, kind);
    const solvers = solversOf(list);
    const ratios = new Map(solvers.map(solver => [solver, []]));
    let unsolved = 0;
    for (const runs of list) {
      // A start that is there already costs 0: one unit then stands for nothing.
      const floor = kAlong[measure].isTime ? 1e-9 : 1;
      const costs = solvers.map(solver =>
        runs.has(solver) ? Math.max(costOf(runs.get(solver), target, measure, own) ?? Infinity, floor)
                         : Infinity);
      const best = Math.min(...costs);
      if (best === Infinity) unsolved += 1;
      solvers.forEach((solver, k) => {
        if (costs[k] < Infinity) ratios.get(solver).push(costs[k] / best);
      });
    }
    const widest = Math.max(2, ...[...ratios.values()].flat());
    const data = solvers.flatMap(solver =>
      steps(solver, ratios.get(solver), list.length, 1, widest * 1.2));
    const caption = `Dolan and Moré (2002): share of ${counted(list.length, 'instance')} that a ` +
      `solver brings to ${targetText(target)} with at most tau times the ` +
      `${manyOf(measure)} of the best solver there. ` +
      failureText(list.flatMap(runs => [...runs.values()])) +
      basinText(own) + ` ${counted(unsolved, 'instance')} solved by none count for all. A profile of more than two ` +
      'solvers is no order of any two: filter to a pair for that.' +
      excludedText([[numOverlapped, 'timed while other runs went on (overlapped)']]);
    return shareSpec({ width, solvers, data, caption, logX: true,
                       x: `tau: ${manyOf(measure)} over the least of all solvers, no unit`,
                       y: 'share of instances' });
  });
}

// Hansen et al., COCO, 2021: share of (instance, target) pairs reached within a budget.
function runtimePlot(settings, kind, own) {
  return new Plot(profileTitle('Runtime distribution', kind, own), width => {
    const { measure } = settings;
    const { list, numOverlapped } = instances(measure, kind);
    const solvers = solversOf(list);
    const least = kAlong[measure].isTime ? 1e-7 : 1;
    const times = new Map(solvers.map(solver => [solver, list.flatMap(runs =>
      runs.has(solver) ? kTargets.map(target => costOf(runs.get(solver), target, measure, own))
        .filter(cost => isNumber(cost)).map(cost => Math.max(cost, least)) : [])]));
    const all = [...times.values()].flat();
    const longest = Math.max(2 * least, ...all);
    const shortest = Math.min(longest / 2, ...all);
    const data = solvers.flatMap(solver =>
      steps(solver, times.get(solver), list.length * kTargets.length, shortest, longest * 1.2));
    const caption = `Share of ${counted(list.length * kTargets.length, 'pair')} of an instance and a ` +
      `target (gaps 1e-1, 1e-2, ... 1e-10) reached within a budget, in ${manyOf(measure)}. ` +
      failureText(list.flatMap(runs => [...runs.values()])) + basinText(own) +
      excludedText([[numOverlapped, 'timed while other runs went on (overlapped)']]);
    return shareSpec({ width, solvers, data, caption, logX: true, x: kAlong[measure].title,
                       y: 'share of instances and targets' });
  });
}

// The corners of a distribution function of `total` values of which some are missing.
function steps(solver, values, total, begin, end) {
  const sorted = [...values].sort((a, b) => a - b);
  const points = [{ solver, run: solver, px: begin, py: 0 }];
  sorted.forEach((value, k) => {
    if (k + 1 < sorted.length && sorted[k + 1] === value) return;
    points.push({ solver, run: solver, px: value, py: (k + 1) / total });
  });
  points.push({ ...points.at(-1), px: end });
  return points;
}

function shareSpec({ width, solvers, data, caption, logX, x, y }) {
  if (data.length === 0) return { caption };
  putMarks(data);
  return {
    caption, data, zooms: true, logs: { px: logX, py: false },
    columns: { solver: 'solver', px: x, py: y },
    spec: lineSpec({
      width, height: heightFor(width, solvers), solvers, data, interpolate: 'step-after',
      x: axisOf('px', x, logX), y: axisOf('py', y, false, { scale: { domain: [0, 1.02] } }),
      tooltip: [{ field: 'solver', title: 'solver' }, { field: 'px', title: x, format: '.4~g' },
                { field: 'py', title: y, format: '.3f' }],
    }),
  };
}

// --- Where runs end.
function endPlot(settings) {
  return new Plot('Where the runs end', width => {
    const along = kAlong[settings.along];
    const cost = settings.along === 'iteration' ? 'iterations' : settings.along;
    const ran = chosen.filter(row => row.verdict !== 'skipped');
    const timed = ran.filter(row => !(along.isTime && isOverlapped(row)));
    const data = timed.map(row => ({ ...pick(row, ['problem', 'solver', 'stop', 'key']),
                                     px: row[cost], py: row.gradient_norm / row.start_gradient_norm }))
      .filter(row => row.px > 0 && row.py > 0 && isNumber(row.px) && isNumber(row.py));
    const solvers = allSolvers.filter(solver => data.some(row => row.solver === solver));
    const title = '|g| at the end over |g| at the start, no unit';
    const caption = `${title}, against ${along.title}: each run a mark.` +
      excludedText([[chosen.length - ran.length, 'skipped'],
                    [ran.length - timed.length, 'timed while other runs went on (overlapped)'],
                    [timed.length - data.length, 'without these numbers, or with 0']]);
    if (data.length === 0) return { caption };
    return {
      caption, data, zooms: true, logs: { px: true, py: true },
      columns: { problem: 'problem', solver: 'solver', key: 'key', stop: 'stop', px: along.title,
                 py: title },
      spec: dotSpec({ width, height: heightFor(width, solvers), solvers,
                      x: axisOf('px', along.title, true, { scale: { padding: 12 } }),
                      y: axisOf('py', title, true, { scale: { padding: 12 } }),
                      tooltip: [{ field: 'problem', title: 'problem' },
                                { field: 'solver', title: 'solver' },
                                { field: 'stop', title: 'stop' },
                                { field: 'px', title: along.title, format: '.5~g' },
                                { field: 'py', title, format: '.3~g' }] }),
    };
  });
}
const pick = (row, fields) => Object.fromEntries(fields.map(field => [field, row[field] ?? '']));
