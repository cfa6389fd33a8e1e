// Pairs of solvers and work units on the page, against counts made here from the rows as they stand, and
// against the tables of bench.

// The rows of a table of the folder by the names of its columns.
function linesOf(name) {
  const { columns, rows: lists } = doc.tables.find(table => table.name === name) ?? { rows: [] };
  return lists.map(list => Object.fromEntries(list.map((value, k) => [columns[k], value])));
}
// The page of bench_suite.json, which has close pairs and several minima; a small benchmark has none.
const isOfSuite = doc.name === 'bench';
const isMany = list => list.length > (isOfSuite ? 10 : 0);

// The numbers that the caption of a pair profile says.
function pairCounts(plot) {
  const text = plot.caption.textContent;
  const number = pattern => Number((text.match(pattern) ?? [])[1] ?? NaN);
  const none = !plot.drawn.spec;
  return none ? { first: 0, second: 0, equal: 0, neither: 0, instances: 0 } : {
    first: number(/comes there alone, on (\d+) of/), second: number(/instances?, .* on (\d+); both/),
    equal: number(/need the same on (\d+)/), neither: number(/neither comes there on (\d+)\./),
    instances: number(/ of (\d+) instances?,/) };
}

async function testPairProfiles({ expect, change, selectOf }) {
  const plots = allPlots.filter(plot => plot.title.startsWith('Pair profile') && !plot.figure.closest('[hidden]'));
  const { common, fields, rows: lists } = doc.cells;
  const raw = lists.map(list => ({ ...common, ...Object.fromEntries(list.map((value, k) => [fields[k], value])) }));
  const kindOfProblem = new Map(raw.filter(row => row.parameter_kind).map(row => [row.problem, row.parameter_kind]));
  const kinds = new Set(raw.map(row => kindOfProblem.get(row.problem)));
  expect('a pair profile for each kind of parameters, where there are two problems',
    plots.length === (doc.groups.length > 1 ? kinds.size : 0));
  const choose = async (plot, pair) => {
    plot.figure.querySelectorAll('select').forEach((node, k) => change(node, pair[k]));
    await plot.draw();
  };
  const chosenPair = plot => [...plot.figure.querySelectorAll('select')].map(node => node.value);
  const namesOf = plot => [...plot.figure.querySelector('select').options].map(option => option.value);

  for (const plot of plots) {
    const [a, b] = chosenPair(plot);
    const names = namesOf(plot), kind = plot.title.match(/(\w+) parameters/)?.[1];
    const some = names.some((x, k) => names.slice(k + 1).some(y =>
      expectedCounts([x, y], kind, selectOf('Measured by').value, selectOf('Solved means').value).instances > 0));
    expect(`${plot.title}: begins with two`, a !== '' && b !== '' && a !== b && some === Boolean(plot.drawn.spec) &&
      (plot.drawn.data ?? []).every(row => row.solver === a || row.solver === b));
    // Not with one that comes nowhere, as one that crashes, where two others do.
    const counts = pairCounts(plot);
    if (doc.name === 'jobs') expect(`${plot.title}: begins with two that come there`, counts.instances > 0 && a !== 'faulty' && b !== 'faulty');
    expect(`${plot.title}: solvers can be chosen by the keyboard`,
      [...plot.figure.querySelectorAll('select')].every(node => { node.focus(); return document.activeElement === node; }));
    change(plot.figure.querySelector('select'), b);
    await plot.draw();
    expect(`${plot.title}: never one solver twice`, chosenPair(plot).join() === [b, a].join());
  }
  const usual = [selectOf('Measured by').value, selectOf('Solved means').value];
  for (const [measure, target] of [['evaluations', 'stop'], ['iteration', '0.001'], ['evaluations', '1e-8']]) {
    change(selectOf('Measured by'), measure);
    change(selectOf('Solved means'), target);
    for (const plot of plots) await testCounts(plot, measure, target);
  }
  if (doc.tables.some(table => table.name === 'pairs.csv')) await testAgainstBench();
  change(selectOf('Measured by'), usual[0]);
  change(selectOf('Solved means'), usual[1]);

  async function testCounts(plot, measure, target) {
    const names = namesOf(plot), kind = plot.title.match(/(\w+) parameters/)?.[1];
    for (let k = 0; k + 1 < names.length && k < 8; ++k) {
      const pair = [names[k], names[k + 1]];
      await choose(plot, pair);
      const mine = expectedCounts(pair, kind, measure, target);
      expect(`${plot.title}, ${pair.join(' and ')}, ${measure} to ${target}: ${JSON.stringify(mine)}`,
        JSON.stringify(pairCounts(plot)) === JSON.stringify(mine));
    }
  }

  function expectedCounts(pair, kind, measure, target) {
    const counts = { first: 0, second: 0, equal: 0, neither: 0, instances: 0 };
    const runsOf = new Map();
    raw.forEach((row, k) => {
      if (row.stop === 'skipped' || (kind && kindOfProblem.get(row.problem) !== kind)) return;
      const { minimum } = doc.groups[rows[k].group];
      const fall = raw.find((other, j) => rows[j].group === rows[k].group && isNumber(other.start_energy))?.start_energy - minimum;
      if (target !== 'stop' && !(Number(target) * fall > 1000 * Number.EPSILON * Math.abs(minimum))) return;
      const id = ['problem', 'terms', 'data_seed', 'start_seed', 'seed'].map(name => row[name]).join('|');
      if (!runsOf.has(id)) runsOf.set(id, {});
      (runsOf.get(id)[row.solver] ??= []).push({ ...row, verdict: rows[k].verdict });
    });
    for (const runs of runsOf.values()) {
      const [a, b] = pair.map(solver => runs[solver]);
      const hasMinima = Object.values(runs).flat().some(run => run.basin >= 1);
      if (!a || !b || (hasMinima && (!a[0].basin || a[0].basin !== b[0].basin))) continue;
      const [x, y] = [a, b].map(some => medianOf(some.map(run => expectedCost(run, measure, target))));
      counts.instances += 1;
      counts[x === y ? (x === Infinity ? 'neither' : 'equal') : x < y ? 'first' : 'second'] += 1;
    }
    return counts;
  }
  function medianOf(costs) {
    costs.sort((x, y) => Math.sign(x - y) || 0);
    return (costs[Math.floor((costs.length - 1) / 2)] + costs[Math.floor(costs.length / 2)]) / 2;
  }
  function expectedCost(run, measure, target) {
    if (target === 'stop') {
      const calls = run.energy_calls + run.gradient_calls + run.jacobian_calls + run.products;
      return run.verdict === 'reached' ? Math.max(1, measure === 'iteration' ? run.iterations : calls) : Infinity;
    }
    const trace = traces()[run.key], place = doc.targets.indexOf(Number(target));
    const value = trace && run.verdict !== 'refuted'
      ? (trace[8] ?? trace[7])[measure === 'iteration' ? 0 : 1][place] : null;
    return value === null ? Infinity : Math.max(1, value);
  }

  // A row of its table is of one kind of parameters, and of medians over repetitions.
  async function testAgainstBench() {
    change(selectOf('Measured by'), 'evaluations');
    change(selectOf('Solved means'), '0.001');
    const refuted = new Set(rows.filter(row => row.verdict === 'refuted').map(row => row.solver));
    const known = linesOf('pairs.csv').filter(row => [row.first, row.second].every(name =>
      allSolvers.includes(name) && !refuted.has(name)));
    const usable = known.filter(row => row.target === 'gap 0.001' && row.cost === 'evaluations');
    const close = usable.filter(row => Number(row.first_less) > 0 && Number(row.second_less) > 0);
    const tried = [...close, ...usable.filter((_, k) => k % 25 === 0)];
    expect('each pair of bench can be compared', known.every(row =>
      usable.some(({ kind, first, second }) => kind === row.kind && first === row.first && second === row.second)));
    if (isOfSuite) expect('some pairs of bench are close', close.length > 0 && tried.length > 5);
    for (const row of tried) {
      const sum = { first: 0, second: 0, equal: 0, neither: 0, instances: 0 };
      const withinTwo = [0, 0];
      const ofKind = plots.filter(plot => (plot.title.match(/(\w+) parameters/)?.[1] ?? row.kind) === row.kind);
      for (const plot of ofKind.filter(p => [row.first, row.second].every(name => namesOf(p).includes(name)))) {
        await choose(plot, [row.first, row.second]);
        const counts = pairCounts(plot);
        for (const name of Object.keys(sum)) sum[name] += counts[name];
        [row.first, row.second].forEach((solver, k) => {
          const shares = (plot.drawn.data ?? []).filter(point => point.solver === solver && point.px <= 2);
          withinTwo[k] += Math.max(0, ...shares.map(point => point.py)) * counts.instances;
        });
      }
      const names = { first: 'first_less', second: 'second_less', equal: 'equal', neither: 'neither', instances: 'instances' };
      expect(`${row.kind}, ${row.first} and ${row.second} as in pairs.csv`, Object.entries(names).every(([name, column]) =>
        sum[name] === Number(row[column])));
      expect(`${row.kind}, ${row.first} and ${row.second}: profiles at 2 as in pairs.csv`, ['first_at_2', 'second_at_2']
        .every((column, k) => Math.abs(withinTwo[k] / sum.instances - Number(row[column])) < 1e-4));
    }
  }
}

// How many instances a solver brings to each target of the suite, as solvers.csv has it.
async function testAgainstTables({ expect, change, selectOf }) {
  const lines = linesOf('solvers.csv');
  if (lines.length === 0) return;
  const refuted = new Set(rows.filter(row => row.verdict === 'refuted').map(row => row.solver));
  const usual = selectOf('Solved means').value;
  const names = [...selectOf('Solved means').options].filter(option => option.textContent.endsWith('(of the suite)'));
  const nameOfTable = target => Number(target) === 0 ? 'noise floor' : `gap ${Number(target)}`;
  const ofTable = name => name === 'noise floor' ? name : `gap ${Number(name.slice(4))}`;
  expect('the targets of the suite are offered', new Set(lines.map(line => ofTable(line.target))).size <= names.length &&
    lines.every(line => names.some(option => nameOfTable(option.value) === ofTable(line.target))));
  for (const option of names) {
    change(selectOf('Solved means'), option.value);
    const here = lines.filter(line => ofTable(line.target) === nameOfTable(option.value) && !refuted.has(line.solver));
    for (const plot of allPlots.filter(p => /^(Performance|Data) profile/.test(p.title) && !p.title.includes('own basin'))) {
      await plot.draw();
      const kind = plot.title.match(/(\w+) parameters/)?.[1];
      const last = new Map((plot.drawn.data ?? []).map(row => [row.solver, row.py]));
      for (const line of here.filter(one => kind === undefined || one.kind === kind)) {
        const ran = Number(line.instances) - Number(line.not_run);
        expect(`${plot.title}, ${option.textContent}: ${line.solver} comes there on ${line.solved} of ${ran}`,
          plot.caption.textContent.includes(`share of ${counted(Number(line.instances), 'instance')}`) &&
          (ran === 0 || Math.abs((last.get(line.solver) ?? NaN) - Number(line.solved) / ran) < 1e-9));
      }
    }
  }
  change(selectOf('Solved means'), usual);
}

// Whoever comes to the best minimum has come to its own one.
function testBench({ expect }) {
  expect('the notes are there', document.querySelector('#notes_of_the_benchmark').textContent
    .includes('cells are finished'));
  const shares = (what, basin) => allPlots.filter(plot => plot.title.startsWith(what) && plot.title.endsWith(basin))
    .map(plot => new Map((plot.drawn.data ?? []).map(row => [row.solver, row.py])));  // the last of each
  const best = shares('Runtime distribution', 'best basin'), own = shares('Runtime distribution', 'own basin');
  const lines = linesOf('table.csv');
  expect('solvers and problems have the order of the suite, as in the tables',
    [['solver', allSolvers], ['problem', allProblems]].every(([column, all]) =>
      inOrder(lines.map(line => line[column])).join() === all.join()));
  const basins = lines.filter(line => line.basin !== '');
  const kinds = new Set(rows.filter(row => row.parameter_kind && basins.some(line => line.problem === row.problem))
    .map(row => row.parameter_kind));
  expect('own basins stand beside best ones', best.length === kinds.size && own.length === kinds.size);
  expect('own basins are reached as often, and more often where a run ends in a second one', own.every((of, k) =>
    [...of].every(([solver, share]) => share >= (best[k].get(solver) ?? 0))) &&
    (!isOfSuite || own.some((of, k) => [...of].some(([solver, share]) => share > (best[k].get(solver) ?? 0)))) &&
    (basins.some(line => Number(line.basin) > 1) ||
      own.every((of, k) => [...of].every(([solver, share]) => share === (best[k].get(solver) ?? 0)))));
}

// Work units and basins, which the rows of bench do not have, are those of its table.
async function testWorkUnits({ expect, change, selectOf }) {
  const offered = label => [...selectOf(label).options].some(option => option.value === 'work_units');
  // All runs may have overlapped, and then no line has any.
  const hasSome = linesOf('table.csv').some(line => (line.work_units ?? '') !== '');
  expect('work units are offered where there are some', ['Along', 'Measured by'].every(label =>
    offered(label) === hasSome));
  if (!hasSome) return;
  const fields = ['problem', 'terms', 'data_seed', 'start_seed', 'solver', 'seed'];
  const idOf = row => fields.map(field => row[field]).join('|');
  const lines = new Map(linesOf('table.csv').map(line => [idOf(line), line]));
  const runs = new Map(rows.map(row => [idOf(row), rows.filter(other => idOf(other) === idOf(row))]));
  const timed = [...lines].filter(([, line]) => line.work_units !== '').map(([id]) => id);
  const known = timed.filter(id => !runs.get(id)?.some(isOverlapped)).map(id => [id, runs.get(id) ?? []]);
  const isNear = (a, b) => Math.abs(a - b) <= 1e-12 * Math.abs(b);
  expect('work units of runs are those of table.csv', isMany(known) && known.every(([id, some]) =>
    isNear(median(some.map(row => row.work_units)), Number(lines.get(id).work_units))));
  expect('basins are those of table.csv', [...runs].every(([id, some]) =>
    !lines.has(id) || some.every(row => String(row.basin ?? '') === lines.get(id).basin)));
  if (isOfSuite) expect('some end in a second basin', rows.some(row => row.basin === 2));

  const unitOfLine = row => {
    const line = lines.get(idOf(row));
    return Number(line.seconds) / Number(line.work_units);
  };
  const plot = allPlots.find(p => p.title === 'Convergence');
  const drawn = async along => {
    change(selectOf('Along'), along);
    await plot.draw();
    return plot.drawn.data.filter(point => point.iteration > 0);
  };
  const units = await drawn('work_units'), seconds = await drawn('seconds');
  expect('convergence along work units', isMany(units) && units.length === seconds.length && units.every((point, k) => {
    const row = rows.find(({ key }) => key === point.key);
    return isNear(point.px * unitOfLine(row), seconds[k].px);
  }));
  change(selectOf('Along'), 'iteration');
  const reached = rows.filter(row => costOf(row, 0.1, 'seconds', false) < Infinity);
  const place = doc.targets.indexOf(0.1);
  const haveCome = rows.filter(row => row.verdict !== 'refuted' && traces()[row.key]?.[7][2][place] != null);
  expect('work units to a target', isMany(haveCome) && reached.length === haveCome.length && reached.every(row =>
    lines.get(idOf(row)).work_units === '' || isNear(costOf(row, 0.1, 'work_units', false) * unitOfLine(row), costOf(row, 0.1, 'seconds', false))));
}
