// What runs cost up to a target, and what solvers cost on instances: the rules of the tables and
// profiles of bench (docs/formats.md), which the page follows in all folders.

// A target is a gap, 0 for the noise floor (E of the truth) or 'stop': what the run was asked for.
const kTargets = doc.targets;
const suiteTargets = doc.suite_targets;  // of bench

// Of one run. Infinity: it does not come there. null: there is nothing to tell it by. `own`: gaps are
// to the minimum of the basin that the run itself ends in, where the folder tells which.
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

// Of a list with infinities; null where it is empty.
function medianCost(costs) {
  const sorted = [...costs].sort((a, b) => a < b ? -1 : a > b ? 1 : 0);
  const middle = Math.floor(sorted.length / 2);
  if (sorted.length === 0) return null;
  return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

// Of the repetitions of one solver with one seed: their median, of times that of the repetitions that
// ran alone. Who does not come there needs no clock to show it.
function costOfRepetitions(runs, target, measure, own) {
  const median = (some, by) =>
    medianCost(some.map(row => costOf(row, target, by, own)).filter(cost => cost !== null));
  if (!kAlong[measure].isTime) return median(runs, measure);
  const timed = runs.filter(row => !isOverlapped(row) && unitOf(row, measure) !== null);
  if (timed.length > 0) return median(timed, measure);
  return median(runs, 'evaluations') === Infinity ? Infinity : null;
}

// Fits with fixed, free and projected parameters are different problems.
const kindOfGroup = doc.groups.map((_, group) =>
  String(rows.find(row => row.group === group && row.parameter_kind)?.parameter_kind ?? ''));
const kindOf = row => kindOfGroup[row.group];  // skipped runs do not say it
const allKinds = inOrder(rows.map(kindOf));
const hasBasins = kind => rows.some(row => kindOf(row) === kind && traceOf(row)?.[8]);

// Whether an instance has the target: the noise is known, or the gap is more than rounding of E.
const startOfGroup = doc.groups.map((_, group) =>
  rows.find(row => row.group === group && isNumber(row.start_energy))?.start_energy);
function hasTarget(group, target) {
  const { minimum, truth } = doc.groups[group], start = startOfGroup[group];
  if (target === 'stop') return true;
  if (target === 0) return isNumber(truth);
  if (!isNumber(minimum)) return false;
  return start === undefined || target * (start - minimum) > 1000 * 2 ** -52 * Math.abs(minimum);
}

// The instances of one kind of parameters that pass the filters: {group, runs}, with a map for each
// solver that applies to one of them, of its runs by its seed.
function instances(kind) {
  const here = chosen.filter(row => kindOf(row) === kind);
  const applying = new Set(here.filter(row => row.verdict !== 'skipped').map(row => row.solver));
  const byGroup = new Map();
  for (const row of here.filter(one => applying.has(one.solver))) {
    if (!byGroup.has(row.group)) byGroup.set(row.group, { group: row.group, runs: new Map() });
    const { runs } = byGroup.get(row.group), seed = textOf(row.seed);
    if (!runs.has(row.solver)) runs.set(row.solver, new Map());
    if (!runs.get(row.solver).has(seed)) runs.get(row.solver).set(seed, []);
    runs.get(row.solver).get(seed).push(row);
  }
  return [...byGroup.values()];
}
const runsOf = ({ runs }) => [...runs.values()].flatMap(bySeed => [...bySeed.values()].flat());
const solversOf = list => allSolvers.filter(solver => list.some(({ runs }) => runs.has(solver)));

// Of a solver on an instance, the median over its seeds. null: it was not run (excluded, not finished),
// or that cost is not known; this is no failure.
function costOn(instance, solver, target, measure, own) {
  const seeds = [...(instance.runs.get(solver)?.values() ?? [])];
  return medianCost(seeds.map(runs => costOfRepetitions(runs, target, measure, own)).filter(cost => cost !== null));
}
