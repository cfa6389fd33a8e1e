// Profiles: how many instances a solver brings to a target at what cost, of all solvers and of pairs.

// --- How much a run needs to a target, which E* and the whole trace have decided.
// Infinity: it does not come there. null: there is nothing to tell it by. `own`: gaps are to the
// minimum of the basin that the run itself ends in, where the folder tells which.
function costOf(row, target, measure, own) {
  // A start that is there already costs 0: one call, or tick of the clock, then stands for nothing.
  const atLeast = value => Math.max(value, kAlong[measure].isTime ? 1e-9 / unitOf(row, measure) : 1);
  if (target === 'stop') {
    const value = row[measure === 'iteration' ? 'iterations' : measure];
    return row.verdict !== 'reached' ? Infinity : isNumber(value) ? atLeast(value) : null;
  }
  if (row.verdict === 'refuted') return Infinity;
  const trace = traceOf(row);
  if (!trace) return Infinity;
  const value = ((own && trace[8]) || trace[7])[kAlong[measure].column - 1][kTargets.indexOf(target)];
  return isNumber(value) ? atLeast(value / unitOf(row, measure)) : Infinity;
}

// Fits with fixed, free and projected parameters are different problems.
const kindOfGroup = doc.groups.map((_, group) =>
  String(rows.find(row => row.group === group && row.parameter_kind)?.parameter_kind ?? ''));
const kindOf = row => kindOfGroup[row.group];  // skipped runs do not say it
const allKinds = inOrder(rows.map(kindOf));
const hasBasins = kind => rows.some(row => kindOf(row) === kind && traceOf(row)?.[8]);

// The instances of one kind of parameters with the runs of the solvers that apply to one of them, or
// of those that are given; those that were timed beside others not by time.
function instances(measure, kind, solvers = null) {
  const here = chosen.filter(row => kindOf(row) === kind);
  const applying = new Set(here.filter(row => row.verdict !== 'skipped').map(row => row.solver));
  const runs = here.filter(row => solvers ? solvers.includes(row.solver) : applying.has(row.solver));
  const { timed, left } = withCosts(runs, measure);
  const byInstance = new Map();
  for (const row of timed) {
    if (!byInstance.has(row.instanceId)) byInstance.set(row.instanceId, new Map());
    byInstance.get(row.instanceId).set(row.solver, row);
  }
  return { list: [...byInstance.values()], left };
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
  return `Charged as never solved: ${count('refuted')} refuted by the audit or the direct answer, ` +
    `${count('skipped')} skipped since the solver does not apply, and of ${count('failed')} that ` +
    'failed or hit a limit those that miss the target.';
};
// Of a reproduction different solvers run on different problems; a suite can exclude some.
function notRunText(list, solvers) {
  const missing = solvers.map(solver => [solver, list.filter(runs => !runs.has(solver)).length]).filter(([, count]) => count > 0);
  return missing.length === 0 ? '' : ' Not run on all of these instances, and counted there as if they did not come to it: ' +
    missing.map(([solver, count]) => `${solver} on ${count}`).join(', ') + '. Filter for what all were run on.';
}
const targetText = target =>
  target === 'stop' ? 'what the run was asked for (its stop rule)' : `a gap of ${target.toExponential()}`;

// Dolan, More, Benchmarking optimization software with performance profiles, 2002:
// rho_s(tau) = share of instances that s solves within tau times the cost of the best solver.
// costs: a row per instance, a column per solver.
function performanceSteps(solvers, costs) {
  const ratios = solvers.map(() => []);
  for (const row of costs) {
    const best = Math.min(...row);
    row.forEach((cost, k) => { if (cost < Infinity) ratios[k].push(cost / best); });
  }
  const widest = Math.max(2, ...ratios.flat());
  return solvers.flatMap((solver, k) => steps(solver, ratios[k], costs.length, 1, widest * 1.2));
}

function profilePlot(settings, kind, own) {
  return new Plot(profileTitle('Performance profile', kind, own), width => {
    const { measure, target } = settings;
    if (own && target === 'stop') {
      return { caption: 'What a run is asked for is the same in all basins: see the plot to the best one.' };
    }
    const { list, left } = instances(measure, kind);
    const solvers = solversOf(list);
    const costs = list.map(runs => solvers.map(solver =>
      (runs.has(solver) ? costOf(runs.get(solver), target, measure, own) : null) ?? Infinity));
    const unsolved = costs.filter(row => Math.min(...row) === Infinity).length;
    const data = performanceSteps(solvers, costs);
    const caption = `Dolan and Moré (2002): share of ${counted(list.length, 'instance')} that a ` +
      `solver brings to ${targetText(target)} with at most tau times the ` +
      `${nameOf(measure)} of the best solver there.${noteOf(measure)} ` +
      failureText(list.flatMap(runs => [...runs.values()])) + notRunText(list, solvers) +
      basinText(own) + ` ${counted(unsolved, 'instance')} solved by none count for all. A profile of more than two ` +
      'solvers is no order of any two: for that there is the pair profile below.' +
      excludedText(left);
    return shareSpec({ width, solvers, data, caption, logX: true,
                       x: `tau: ${nameOf(measure)} over the least of all, no unit`,
                       y: 'share of instances' });
  });
}

// Hansen et al., COCO, 2021: share of (instance, target) pairs reached within a budget.
function runtimePlot(settings, kind, own) {
  return new Plot(profileTitle('Runtime distribution', kind, own), width => {
    const { measure } = settings;
    const { list, left } = instances(measure, kind);
    const solvers = solversOf(list);
    const times = new Map(solvers.map(solver => [solver, list.flatMap(runs =>
      runs.has(solver) ? kTargets.map(target => costOf(runs.get(solver), target, measure, own))
        .filter(isNumber) : [])]));
    const all = [...times.values()].flat();
    const longest = all.length > 0 ? Math.max(...all) : 1;
    const shortest = Math.min(longest / 2, ...all);
    const data = solvers.flatMap(solver =>
      steps(solver, times.get(solver), list.length * kTargets.length, shortest, longest * 1.2));
    const caption = `Share of ${counted(list.length * kTargets.length, 'pair')} of an instance and a ` +
      `target (gaps 1e-1, 1e-2, ... 1e-10) reached within a budget, in ${nameOf(measure)}.${noteOf(measure)} ` +
      failureText(list.flatMap(runs => [...runs.values()])) + notRunText(list, solvers) + basinText(own) +
      excludedText(left);
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

// --- Pairs: the profile of two solvers alone, which the reader chooses.

// What two runs may be held against each other by, as in the pairs of bench (docs/formats.md): a
// fast way to another minimum is neither won nor lost.
const hasSeveralMinima = doc.groups.map((group, k) =>
  group.basins || rows.some(row => row.group === k && isNumber(row.basin)));
const areInOneBasin = (a, b) =>
  !hasSeveralMinima[a.group] || (isNumber(a.basin) && a.basin === b.basin);

// {costs: a row of two per instance, and how many instances are not among them}.
function pairCosts(list, { measure, target }, pair) {
  const result = { costs: [], alone: 0, apart: 0, unknown: 0 };
  for (const runs of list) {
    const both = pair.map(solver => runs.get(solver));
    if (both.some(row => !row || row.verdict === 'skipped')) {
      result.alone += 1;
    } else if (!areInOneBasin(...both)) {
      result.apart += 1;
    } else {
      const row = both.map(run => costOf(run, target, measure, true));
      if (row.includes(null)) result.unknown += 1; else result.costs.push(row);
    }
  }
  return result;
}

// The two to begin with: who needs least most often, and of those that can be held against it the
// next one.
function firstPair(list, solvers, settings) {
  const wins = new Map(solvers.map(solver => [solver, 0]));
  for (const runs of list) {
    const costs = [...runs].map(([, row]) => costOf(row, settings.target, settings.measure, true) ?? Infinity);
    const best = Math.min(...costs);
    [...runs.keys()].forEach((solver, k) => {
      if (costs[k] < Infinity && costs[k] === best) wins.set(solver, wins.get(solver) + 1);
    });
  }
  const [first, ...others] = [...solvers].sort((a, b) => wins.get(b) - wins.get(a));
  const second = others.find(other => pairCosts(list, settings, [first, other]).costs.length > 0);
  return [first, second ?? others[0]];
}

function pairCaption([a, b], { costs, alone, apart, unknown }, leftRuns, settings, kind) {
  const times = holds => costs.filter(holds).length;
  const isNone = ([x, y]) => x === Infinity && y === Infinity;
  const several = rows.some(row => kindOf(row) === kind && hasSeveralMinima[row.group]);
  const left = [[alone, 'instance', 'to which one of them does not apply, or without its run'],
                [apart, 'instance', 'where their ends are not known to be one minimum'],
                [unknown, 'instance', 'without these numbers'],
                ...leftRuns.map(([number, text]) => [number, 'run', text])]
    .filter(([number]) => number > 0).map(([number, what, text]) => `${counted(number, what)} ${text}`);
  return `${a} and ${b}, ${nameOf(settings.measure)} to ${targetText(settings.target)}: ` +
    `${a} needs less, or comes there alone, on ${times(([x, y]) => x < y)} of ` +
    `${counted(costs.length, 'instance')}, ${b} on ${times(([x, y]) => y < x)}; both need the same on ` +
    `${times(row => row[0] === row[1] && !isNone(row))}, neither comes there on ${times(isNone)}. ` +
    'The lines are the performance profile of these two alone.' + noteOf(settings.measure) +
    (several ? ' Where there are several minima, runs are compared that end in the same one' +
      (settings.target === 'stop' ? '.' : hasBasins(kind) ? '; gaps are to that.'
        : '; gaps are to the lowest E that any run of the folder saw.') : '') +
    (left.length > 0 ? ` Left out: ${left.join('; ')}.` : '');
}

function pairPlot(settings, kind) {
  let pair = [];
  const choose = (k, solver) => {
    if (pair[1 - k] === solver) pair[1 - k] = pair[k];
    pair[k] = solver;
    plot.refresh();
  };
  const choices = ['Solver A', 'Solver B'].map((label, k) =>
    select(label, [], '', solver => choose(k, solver)));
  const offer = solvers => choices.forEach((choice, k) => {
    const node = choice.querySelector('select');
    node.replaceChildren(...solvers.map(solver => element('option', { value: solver }, solver)));
    node.value = pair[k] ?? '';
  });
  const title = profileTitle('Pair profile', kind, true);
  const plot = new Plot(title, width => {
    const { measure } = settings;
    const { list } = instances(measure, kind);
    const solvers = solversOf(list);
    // What filters take away is chosen anew.
    if (!pair.every(solver => solvers.includes(solver)) || pair.length === 0) {
      pair = solvers.length < 2 ? [] : firstPair(list, solvers, settings);
    }
    offer(solvers);
    if (pair.length === 0) return { caption: 'A pair needs two solvers that apply.' };
    const both = instances(measure, kind, pair);
    const compared = pairCosts(both.list, settings, pair);
    const caption = pairCaption(pair, compared, both.left, settings, kind);
    if (compared.costs.length === 0) return { caption };
    return shareSpec({ width, solvers: allSolvers.filter(solver => pair.includes(solver)),
                       data: performanceSteps(pair, compared.costs), caption, logX: true,
                       x: `tau: ${nameOf(measure)} over the lesser of both, no unit`,
                       y: 'share of instances' });
  }, element('div', { class: 'row', role: 'group', 'aria-label': `Solvers of: ${title}` }, ...choices));
  return plot;
}
