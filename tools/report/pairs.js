// Pairs: the performance profile of two solvers alone, which the reader chooses.

// What two runs may be held against each other by, as in the pairs of bench (docs/formats.md): a
// fast way to another minimum is neither won nor lost.
const hasSeveralMinima = doc.groups.map((group, k) =>
  group.basins || rows.some(row => row.group === k && isNumber(row.basin)));
const areInOneBasin = (a, b) =>
  !hasSeveralMinima[a.group] || (isNumber(a.basin) && a.basin === b.basin);

// {costs: a row of two per instance and seed, and how many of these are not among them}. Instances
// without the target are none.
function pairCosts(list, { measure, target }, pair) {
  const result = { costs: [], alone: 0, apart: 0, unknown: 0 };
  for (const { group, runs } of list.filter(instance => hasTarget(instance.group, target))) {
    const [first, second] = pair.map(solver => runs.get(solver) ?? new Map());
    for (const seed of new Set([...first.keys(), ...second.keys()])) {
      const both = [first.get(seed), second.get(seed)];
      if (both.some(some => !some || some[0].verdict === 'skipped')) {
        result.alone += 1;
      } else if (!areInOneBasin(both[0][0], both[1][0])) {
        result.apart += 1;
      } else {
        const row = both.map(some => costOfRepetitions(some, target, measure, true));
        if (row.includes(null)) result.unknown += 1; else result.costs.push(row);
      }
    }
  }
  return result;
}

// The two to begin with: who needs least most often (of equal ones: who comes there most often), and of
// those that can be held against it the next one. Where there is none, the next takes its place.
function firstPair(list, solvers, settings) {
  const wins = new Map(solvers.map(solver => [solver, 0])), solved = new Map(wins);
  for (const instance of list) {
    const costs = solvers.map(solver => costOn(instance, solver, settings.target, settings.measure, true) ?? Infinity);
    const best = Math.min(...costs);
    solvers.forEach((solver, k) => {
      if (costs[k] === Infinity) return;
      solved.set(solver, solved.get(solver) + 1);
      if (costs[k] === best) wins.set(solver, wins.get(solver) + 1);
    });
  }
  const order = [...solvers].sort((a, b) =>
    wins.get(b) - wins.get(a) || solved.get(b) - solved.get(a));
  for (const [k, first] of order.entries()) {
    const second = order.slice(k + 1).find(other => pairCosts(list, settings, [first, other]).costs.length > 0);
    if (second !== undefined) return [first, second];
  }
  return order.slice(0, 2);
}

function leftOfPair({ alone, apart, unknown }, leftRuns) {
  const left = [[alone, 'instance', 'to which one of them does not apply, or without its run'],
                [apart, 'instance', 'where their ends are not known to be one minimum'],
                [unknown, 'instance', 'without these numbers'],
                ...leftRuns.map(([number, text]) => [number, 'run', text])]
    .filter(([number]) => number > 0).map(([number, what, text]) => `${counted(number, what)} ${text}`);
  return left.length > 0 ? ` Left out: ${left.join('; ')}.` : '';
}

function pairCaption([a, b], { costs, ...others }, leftRuns, settings, kind) {
  const left = leftOfPair(others, leftRuns);
  if (costs.length === 0) return `${a} and ${b} cannot be held against each other here.${left}`;
  const times = holds => costs.filter(holds).length;
  const isNone = ([x, y]) => x === Infinity && y === Infinity;
  const several = rows.some(row => kindOf(row) === kind && hasSeveralMinima[row.group]);
  return `${a} and ${b}, ${nameOf(settings.measure)} to ${targetText(settings.target)}: ` +
    `${a} needs less, or comes there alone, on ${times(([x, y]) => x < y)} of ` +
    `${counted(costs.length, 'instance')}, ${b} on ${times(([x, y]) => y < x)}; both need the same on ` +
    `${times(row => row[0] === row[1] && !isNone(row))}, neither comes there on ${times(isNone)}. ` +
    'The lines are the performance profile of these two alone.' + noteOf(settings.measure) + kInstance +
    (several ? ' Where there are several minima, runs are compared that end in the same one' +
      (settings.target === 'stop' ? '.' : hasBasins(kind) ? '; gaps are to that.'
        : '; gaps are to the lowest E that any run of the folder saw.') : '') + left;
}

function pairPlot(settings, kind) {
  let pair = [], isChosen = false;
  const choose = (k, solver) => {
    if (pair[1 - k] === solver) pair[1 - k] = pair[k];
    pair[k] = solver;
    isChosen = true;
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
  const box = element('div', { class: 'row', role: 'group', 'aria-label': `Solvers of: ${title}` }, ...choices);
  const plot = new Plot(title, width => {
    const { measure } = settings;
    const list = instances(kind), solvers = solversOf(list);
    // What filters take away is chosen anew; and what the page chose, for each target and cost.
    if (!isChosen || !pair.every(solver => solvers.includes(solver))) {
      isChosen = false;
      pair = solvers.length < 2 ? [] : firstPair(list, solvers, settings);
    }
    box.hidden = pair.length === 0;
    if (pair.length === 0) return { caption: 'A pair needs two solvers that apply.' };
    offer(solvers);
    const compared = pairCosts(list, settings, pair);
    const ofPair = list.flatMap(runsOf).filter(row => pair.includes(row.solver));
    const caption = pairCaption(pair, compared, withCosts(ofPair, measure).left, settings, kind);
    if (compared.costs.length === 0) return { caption };
    return shareSpec({ width, solvers: allSolvers.filter(solver => pair.includes(solver)),
                       data: performanceSteps(pair, compared.costs), caption, logX: true,
                       x: `tau: ${nameOf(measure)} over the lesser of both, no unit`,
                       y: 'share of instances' });
  }, box);
  return plot;
}
