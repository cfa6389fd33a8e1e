// Profiles: how many instances a solver brings to a target at what cost.

function profileTitle(what, kind, own) {
  return [what, kind && `${kind} parameters`, hasBasins(kind) && (own ? 'own basin' : 'best basin')]
    .filter(Boolean).join(', ');
}
const basinText = own => own
  ? ' Gaps are to the minimum of the basin that a run itself ends in: a fast way to a worse minimum counts.'
  : '';
const targetText = target => target === 'stop' ? 'what the run was asked for (its stop rule)'
  : target === 0 ? 'E of the truth (the noise floor)' : `a gap of ${target.toExponential()}`;
const targetName = target => target === 'stop' ? 'what the run was asked for'
  : target === 0 ? 'noise floor' : `gap ${target.toExponential()}`;

const failureText = runs => {
  const count = verdict => runs.filter(row => row.verdict === verdict).length;
  return `Charged as never solved: of the runs ${count('refuted')} refuted by the audit or the direct answer, ` +
    `${count('skipped')} skipped since the solver does not apply, and of ${count('failed')} that ` +
    'failed or hit a limit those that miss the target.';
};
// Of a reproduction different solvers run on different problems; a suite can exclude some, and times
// of runs beside others are not known. `known`: of each solver, how many of `total` it has.
function knownText(solvers, known, total, what) {
  const some = solvers.flatMap((solver, k) => known[k] < total ? [`${solver} on ${known[k]}`] : []);
  return some.length === 0 ? ` All were run on all ${total}.`
    : ` Where a solver was not run is no failure: its share is of the ${what}s that it was run on and whose cost is ` +
      `known, all ${total}, but ${some.join(', ')}.`;
}
const kInstance = ' An instance is a problem with its terms and seeds; of repetitions the median counts.';
const noTargetText = number => number === 0 ? ''
  : ` Not among them: ${counted(number, 'instance')} without this target (the gap is rounding of E, or E* or the noise is not known).`;
// Runs whose times do not count.
const leftOfTimes = (list, measure) => excludedText(withCosts(list.flatMap(runsOf), measure).left);

// {solvers, list, costs, lost}: costs have a row for each instance of the list, which has the target,
// and a column for each solver; null: not run, or not known. `lost` instances do not have it.
function costTable(kind, { target, measure }, own) {
  const all = instances(kind), list = all.filter(({ group }) => hasTarget(group, target));
  const solvers = solversOf(all);
  return { solvers, list, lost: all.length - list.length,
           costs: list.map(instance => solvers.map(solver => costOn(instance, solver, target, measure, own))) };
}
const knownOf = (solvers, costs) => solvers.map((_, k) => costs.filter(row => row[k] !== null).length);

// Dolan, More, Benchmarking optimization software with performance profiles, 2002:
// rho_s(tau) = share of the instances of s that it solves within tau times the cost of the best solver.
function performanceSteps(solvers, costs) {
  const ratios = solvers.map(() => []);
  for (const row of costs) {
    const best = Math.min(...row.filter(cost => cost !== null));
    row.forEach((cost, k) => { if (cost !== null && cost < Infinity) ratios[k].push(cost / best); });
  }
  const known = knownOf(solvers, costs);
  const widest = ratios.flat().reduce((most, ratio) => Math.max(most, ratio), 2);
  return solvers.flatMap((solver, k) => steps(solver, ratios[k], known[k], 1, widest * 1.2));
}

function profilePlot(settings, kind, own) {
  return new Plot(profileTitle('Performance profile', kind, own), width => {
    const { measure, target } = settings;
    if (own && target === 'stop') return { caption: kSameInAllBasins };
    const { solvers, list, costs, lost } = costTable(kind, settings, own);
    const unsolved = costs.filter(row => !row.some(cost => cost !== null && cost < Infinity)).length;
    const caption = `Dolan and Moré (2002): share of ${counted(list.length, 'instance')} that a ` +
      `solver brings to ${targetText(target)} with at most tau times the ` +
      `${nameOf(measure)} of the best solver there.${noteOf(measure)}${kInstance}` +
      knownText(solvers, knownOf(solvers, costs), list.length, 'instance') + noTargetText(lost) + ' ' +
      failureText(list.flatMap(runsOf)) + basinText(own) +
      ` ${counted(unsolved, 'instance')} solved by none count for all. A profile of more than two ` +
      'solvers is no order of any two: for that there is the pair profile below.' +
      leftOfTimes(list, measure);
    return shareSpec({ width, solvers, data: performanceSteps(solvers, costs), caption, logX: true,
                       x: `tau: ${nameOf(measure)} over the least of all, no unit`,
                       y: 'share of instances' });
  });
}
const kSameInAllBasins = 'What a run is asked for is the same in all basins: see the plot to the best one.';

// Distribution functions of lists of costs, one a solver, in which null is not known.
function distributionSteps(solvers, lists) {
  const known = lists.map(list => list.filter(cost => cost !== null));
  const all = known.flat().filter(Number.isFinite);
  const longest = all.reduce((most, cost) => Math.max(most, cost), all.length > 0 ? 0 : 1);
  const shortest = all.reduce((least, cost) => Math.min(least, cost), longest / 2);
  return solvers.flatMap((solver, k) =>
    steps(solver, known[k].filter(Number.isFinite), known[k].length, shortest, longest * 1.2));
}

// More, Wild, Benchmarking derivative-free optimization algorithms, 2009: share of instances that are
// solved within a budget; of evaluations in units of n + 1, where all n are known.
function dataProfilePlot(settings, kind, own) {
  return new Plot(profileTitle('Data profile', kind, own), width => {
    const { measure, target } = settings;
    if (own && target === 'stop') return { caption: kSameInAllBasins };
    const { solvers, list, costs, lost } = costTable(kind, settings, own);
    const sizeOf = ({ group }) => doc.groups[group].num_variables;
    const isScaled = measure === 'evaluations' && list.every(instance => isNumber(sizeOf(instance)));
    const scaled = !isScaled ? costs : costs.map((row, k) =>
      row.map(cost => cost === null ? null : cost / (sizeOf(list[k]) + 1)));
    const x = isScaled ? 'evaluations / (n + 1), no unit' : kAlong[measure].title;
    const caption = `Moré and Wild (2009): share of ${counted(list.length, 'instance')} that a solver brings ` +
      `to ${targetText(target)} within a budget, in ${isScaled ? 'evaluations over n + 1' : nameOf(measure)}.` +
      (isScaled ? ' n is the number of variables.' : '') + noteOf(measure) + kInstance +
      knownText(solvers, knownOf(solvers, costs), list.length, 'instance') + noTargetText(lost) + ' ' +
      failureText(list.flatMap(runsOf)) + basinText(own) + leftOfTimes(list, measure);
    const lists = solvers.map((_, k) => scaled.map(row => row[k]));
    return shareSpec({ width, solvers, data: distributionSteps(solvers, lists), caption, logX: true,
                       x, y: 'share of instances' });
  });
}

// Hansen et al., COCO, 2021: share of (instance, target) pairs reached within a budget.
function runtimePlot(settings, kind, own) {
  return new Plot(profileTitle('Runtime distribution', kind, own), width => {
    const { measure } = settings;
    const list = instances(kind), solvers = solversOf(list);
    const targets = suiteTargets.length > 0 ? suiteTargets : kTargets;
    const pairs = list.flatMap(instance => targets.filter(target => hasTarget(instance.group, target))
      .map(target => [instance, target]));
    const costs = pairs.map(([instance, target]) =>
      solvers.map(solver => costOn(instance, solver, target, measure, own)));
    const caption = `Share of ${counted(pairs.length, 'pair')} of an instance and a ` +
      `target (${suiteTargets.length > 0 ? `those of the suite: ${targets.map(targetName).join(', ')}` : 'gaps 1e-1, 1e-2, ... 1e-10'}) ` +
      `reached within a budget, in ${nameOf(measure)}.${noteOf(measure)}${kInstance}` +
      knownText(solvers, knownOf(solvers, costs), pairs.length, 'pair') + ' ' +
      failureText(list.flatMap(runsOf)) + basinText(own) + leftOfTimes(list, measure);
    return shareSpec({ width, solvers, caption, logX: true, x: kAlong[measure].title, y: 'share of instances and targets',
                       data: distributionSteps(solvers, solvers.map((_, k) => costs.map(row => row[k]))) });
  });
}

// The corners of a distribution function of `total` values of which some are missing.
function steps(solver, values, total, begin, end) {
  if (total === 0) return [];
  const sorted = [...values].sort((a, b) => a - b);
  const points = [{ solver, run: solver, px: begin, py: 0 }];
  sorted.forEach((value, k) => {
    if (k + 1 < sorted.length && sorted[k + 1] === value) return;
    points.push({ solver, run: solver, px: value, py: (k + 1) / total });
  });
  points.push({ ...points.at(-1), px: end });
  return points;
}

function shareSpec({ width, solvers: all, data, caption, logX, x, y }) {
  if (data.length === 0) return { caption };
  const solvers = all.filter(solver => data.some(row => row.solver === solver));
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
