// The sections of the page, but the player.

// A section whose content is made anew from the rows that pass the filters; only once it is seen.
function addTableSection(title, fill) {
  const box = element('div');
  addRunSection(title, box, () =>
    box.replaceChildren(...(chosen.length > 0 ? [fill()].flat().filter(Boolean) : [])));
}
const verdictWords = { reached: 'reached', failed: 'failed', refuted: 'refuted', skipped: 'skipped' };
const verdictCell = row => element('span', {
  class: row.verdict === 'reached' ? 'good' : row.verdict === 'skipped' ? null : 'bad',
}, verdictWords[row.verdict]);

function addRunSections() {
  addTableSection('Summary', summaryContent);
  addConvergence();
  addProfiles();
  addPlayer();
  addTableSection('Runs', runsContent);
  addTableSection('Failures', failuresContent);
  addTableSection('Claim and audit', auditContent);
  addTableSection('Options that ran', optionsContent);
}

function summaryContent() {
  const count = (list, verdict) => list.filter(row => row.verdict === verdict).length;
  const list = allSolvers.map(solver => {
    const runs = chosen.filter(row => row.solver === solver);
    const good = runs.filter(row => row.verdict === 'reached');
    const timed = good.filter(row => !isOverlapped(row));
    return { solver, runs: runs.length, reached: count(runs, 'reached'),
             failed: count(runs, 'failed'), refuted: count(runs, 'refuted'),
             skipped: count(runs, 'skipped'), iterations: median(good.map(row => row.iterations)),
             evaluations: median(good.map(row => row.evaluations)),
             work_units: median(timed.map(row => row.work_units)),
             seconds: median(timed.map(row => row.seconds)) };
  }).filter(row => row.runs > 0);
  const columns = [
    { field: 'solver', title: 'solver', text: true,
      cell: row => element('span', {}, swatch(row.solver), ' ' + row.solver) },
    { field: 'runs', title: 'runs' }, { field: 'reached', title: 'reached' },
    { field: 'failed', title: 'failed' }, { field: 'refuted', title: 'refuted' },
    { field: 'skipped', title: 'skipped' }, { field: 'iterations', title: 'iterations, median' },
    { field: 'evaluations', title: 'evaluations, median' },
    ...(hasWorkUnits ? [{ field: 'work_units', title: 'work units, median' }] : []),
    { field: 'seconds', title: 'time (s), median' }];
  const numOverlapped = chosen.filter(isOverlapped).length;
  const caption = 'Reached: the run came to what it was asked for and the audit does not refute it. ' +
    'Failed: it did not, or hit a limit. Refuted: it claims what the audit or the direct answer ' +
    'contradicts. Skipped: the solver does not apply. Medians are those of the runs that reached; ' +
    'evaluations are calls of E, its gradient and Jacobian, and products.' +
    (hasWorkUnits ? ' Work units are times over that of one evaluation of E on the same instance.' : '') +
    (numOverlapped > 0 ? ` Times leave out ${counted(numOverlapped, 'run')} that overlapped.` : '');
  return [sortableTable(columns, list, { name: 'summary' }),
          element('p', { class: 'quiet' }, caption)];
}

function addConvergence() {
  const hasTraces = rows.some(traceOf);
  const settings = { group: 0, along: 'iteration', up: 'gap', logX: true };
  const plot = convergencePlot(settings);
  const end = endPlot(settings);
  const changed = () => { plot.refresh(); end.refresh(); };
  const set = name => value => { settings[name] = value; changed(); };
  const problem = groupChoice(doc.groups.map((_, k) => k), group => { settings.group = group; plot.refresh(); });
  const controls = element('div', { class: 'row' }, problem.label,
    select('Along', measures, settings.along, set('along')),
    select('Up', [['gap', 'gap'], ['excess', 'E − E*'], ['energy', 'E'], ['gradient', '|g|']],
           settings.up, set('up')),
    check('Logarithmic along', true, set('logX')));
  const hint = 'Drag to move, Ctrl and wheel or the buttons to zoom, double click to see all. ' +
    'With the keyboard: focus a plot, then + − 0 and the arrows; Values lists what is drawn.';
  addRunSection('Convergence', element('div', {},
    hasTraces ? null : element('p', {}, 'The folder has no traces (traces/KEY.csv).'),
    controls, element('p', { class: 'quiet' }, hint), plot.figure, end.figure),
  () => {
    settings.group = problem.offer(new Set(chosen.map(row => row.group))) ?? settings.group;
    changed();
  });
}

function addProfiles() {
  const hasTraces = rows.some(traceOf);
  // The strictest gap of a suite, as in the pairs of bench.
  const settings = { measure: 'evaluations', target: !hasTraces ? 'stop' : suiteTargets.findLast(gap => gap > 0) ?? 1e-6 };
  // Per kind of parameters; where there are several minima those to the own basin beside.
  const kinds = allKinds.map(kind => {
    const goals = hasBasins(kind) ? [false, true] : [false];
    return [...goals.map(own => profilePlot(settings, kind, own)),
            ...goals.map(own => dataProfilePlot(settings, kind, own)),
            ...(hasTraces ? goals.map(own => runtimePlot(settings, kind, own)) : []),
            pairPlot(settings, kind)];
  });
  const refresh = () => kinds.flat().forEach(plot => plot.refresh());
  const targets = [['stop', 'what the run was asked for'],
                   ...(hasTraces ? kTargets.map(target => [String(target), targetName(target) +
                     (suiteTargets.includes(target) ? ' (of the suite)' : '')]) : [])];
  const controls = element('div', { class: 'row' },
    select('Measured by', measures.filter(([name]) => hasTraces || name !== 'cpu_seconds'),
           settings.measure, value => { settings.measure = value; refresh(); }),
    select('Solved means', targets, String(settings.target), value => {
      settings.target = value === 'stop' ? value : Number(value);
      refresh();
    }));
  const few = element('p', { class: 'none' }, 'Profiles need two problems or more.');
  const nones = allKinds.map(kind => element('p', { class: 'none' }, 'No run that passes the filters is of a solver that applies' +
    (kind ? ` where parameters are ${kind}.` : '.')));
  const boxes = kinds.map(plots => element('div', { class: 'plots' }, ...plots.map(plot => plot.figure)));
  const box = element('div', {}, controls, ...allKinds.flatMap((_, k) => [nones[k], boxes[k]]));
  addRunSection('Profiles', element('div', {}, few, box), () => {
    const isMany = new Set(chosen.map(row => row.group)).size >= 2;
    few.hidden = isMany;
    box.hidden = !isMany;
    allKinds.forEach((kind, k) => {
      nones[k].hidden = instances(kind).length > 0;
      boxes[k].hidden = !nones[k].hidden;
    });
    refresh();
  });
}

// What tells runs of one solver on one problem apart, where the runs of the folder differ in it.
const apartColumns = [
  { field: 'terms', title: 'terms', text: true }, { field: 'data_seed', title: 'data seed' },
  { field: 'start_seed', title: 'start seed' }, { field: 'seed', title: 'seed of the solver' },
  { field: 'repetition', title: 'repetition' },
].filter(({ field }) => new Set(rows.map(row => textOf(row[field]))).size > 1);
// Units stand in the names of columns: short, so that these are no taller than two lines.
const kUnitNote = 'u is the unit of the data.';

const kRunColumns = [
  { field: 'problem', title: 'problem', text: true }, { field: 'solver', title: 'solver', text: true },
  ...(apartColumns[0]?.field === 'terms' ? [] : [{ field: 'terms', title: 'terms', text: true }]), ...apartColumns,
  { field: 'parameter_kind', title: 'parameters', text: true },
  { field: 'verdict', title: 'verdict', text: true, cell: verdictCell },
  { field: 'stop', title: 'stop', text: true }, { field: 'iterations', title: 'iterations' },
  { field: 'evaluations', title: 'evaluations' }, { field: 'work_units', title: 'work units' },
  { field: 'seconds', title: 'time (s)' },
  { field: 'energy', title: 'E (u²)', digits: 6 },
  { field: 'energy_at_foot_points', title: 'E at foot points (u²)', digits: 6 },
  { field: 'gap', title: 'gap' }, { field: 'gradient_norm', title: '|g| (u)' },
  { field: 'rms', title: 'rms distance (u)' }, { field: 'max', title: 'largest distance (u)' },
  { field: 'basin', title: 'basin', text: true }, { field: 'length', title: 'length (u)' },
  { field: 'turning', title: 'turning (rad)' }, { field: 'num_free_loops', title: 'free loops' },
];
function runsContent() {
  // Times beside others tell nothing; they stand among all fields of a run.
  const list = chosen.map(row => isOverlapped(row) ? { ...row, seconds: null, work_units: null } : row);
  const used = kRunColumns.filter(column =>
    list.some(row => row[column.field] !== null && row[column.field] !== undefined));
  const numOverlapped = chosen.filter(isOverlapped).length;
  const details = element('div', { 'aria-live': 'polite' });
  const showRow = row => {
    const { termList, verdict, index, group, options, ...fields } = row;
    const { notes, ...rest } = fields;
    details.replaceChildren(element('h3', { tabindex: -1 }, `${row.problem}: ${row.solver}`),
      element('p', {}, 'Options that really ran:'), definitions(options ?? {}),
      (notes ?? []).length > 0 ? element('p', {}, 'Notes of the solver:') : '',
      definitions(Object.fromEntries((Array.isArray(notes) ? notes : []).map(note => [note.name, note.value]))),
      element('p', {}, 'All fields (docs/formats.md):'), definitions(rest));
    details.firstChild.focus();
  };
  const columns = [...used, { field: 'index', title: 'all', text: true, cell: row =>
    element('button', { type: 'button', onclick: () => showRow(rows[row.index]),
                        'aria-label': `All of ${row.problem}, ${row.solver}` }, 'All') }];
  const caption = kUnitNote +
    (numOverlapped > 0 ? ` Times leave out ${counted(numOverlapped, 'run')} that overlapped: other runs went on beside.` : '');
  return [sortableTable(columns, list, { name: 'runs', page: 20 }), element('p', { class: 'quiet' }, caption), details];
}

function findingTexts(row) {
  const texts = {
    claim_fails: row.failure ? '' : `it claims ${row.stop}, and |g| at its end is ${show(row.gradient_norm)}`,
    ignores_stop: `it ignores stop: ${show(row.calls_past_stop)} calls after it was told`,
    no_finite_end: 'its end is no finite number',
  };
  return Array.isArray(row.findings) ? row.findings.map(finding => texts[finding] ?? '') : [];
}

// Which limit cut a run off that says nothing itself.
function limitText(row) {
  const limit = { iteration_limit: [row.max_iterations, 'iterations'], time_limit: [row.max_seconds, 's of the solver'] }[row.stop];
  return !row.message && isNumber(limit?.[0]) ? `cut off at its limit of ${show(limit[0])} ${limit[1]}` : '';
}

function failuresContent() {
  const list = chosen.filter(row => row.verdict === 'failed' || row.verdict === 'refuted' ||
                                    (row.findings ?? []).length > 0);
  const skipped = chosen.filter(row => row.verdict === 'skipped');
  if (list.length + skipped.length === 0) return element('p', {}, 'None of these runs failed.');
  const logCell = row => {
    const log = doc.logs[row.key];
    if (log === undefined) return '–';
    return element('details', {}, element('summary', {}, 'log'), element('pre', { tabindex: 0 }, log));
  };
  const columns = [
    { field: 'problem', title: 'problem', text: true }, { field: 'solver', title: 'solver', text: true },
    { field: 'verdict', title: 'verdict', text: true, cell: verdictCell },
    { field: 'stop', title: 'stop', text: true }, { field: 'why', title: 'message', text: true },
    { field: 'key', title: 'log', text: true, cell: logCell }, ...apartColumns];
  const why = row => [row.message, limitText(row), row.failure, row.disagreement, ...findingTexts(row)]
    .filter(Boolean).map(textOf).join('; ');
  const withWhy = some => some.map(row => ({ ...row, why: why(row) }));
  return [
    list.length > 0 ? sortableTable(columns, withWhy(list), { name: 'failures', page: 20 })
                    : element('p', {}, 'None of these runs failed.'),
    skipped.length > 0 ? element('details', {},
      element('summary', {}, `${counted(skipped.length, 'run')} skipped: the solver does not apply`),
      sortableTable(columns, withWhy(skipped), { name: 'skipped', page: 30 })) : null];
}

function auditContent() {
  const audited = chosen.filter(row => typeof row.verified === 'boolean').map(row => ({
    ...row,
    energy_off: Math.abs(row.energy - row.audit_energy) / Math.abs(row.audit_energy),
    says: row.verified ? 'verified' : 'refuted',
  }));
  const failed = audited.filter(row => !row.verified).length;
  const disagree = chosen.filter(row => row.disagreement).length;
  const belied = chosen.filter(row => row.verified !== false && finds(row, 'claim_fails')).length;
  const unaudited = chosen.length - audited.length;
  const text = `${counted(audited.length, 'run')} audited, ${failed} of them refuted; ` +
    `${disagree} claim a minimum that is not the direct answer; ${belied} are ` +
    `belied by |g| of their own terms, which the audit does not know all; ${unaudited} not audited ` +
    '(skipped, or with terms that the audit does not know). The audit is a plain evaluator that ' +
    'shares no code with the solvers.';
  const columns = [
    { field: 'problem', title: 'problem', text: true }, { field: 'solver', title: 'solver', text: true },
    ...apartColumns, { field: 'stop', title: 'claim (stop)', text: true },
    { field: 'says', title: 'audit', text: true, cell: row =>
      element('span', { class: row.verified ? 'good' : 'bad' }, row.says) },
    { field: 'energy', title: 'E claimed (u²)', digits: 8 },
    { field: 'audit_energy', title: 'E audited (u²)', digits: 8 },
    { field: 'energy_off', title: 'difference over E', digits: 2 },
    { field: 'gradient_norm', title: '|g| claimed (u)' },
    { field: 'audit_gradient_norm', title: '|g| audited (u)' },
    { field: 'gradient_floor', title: 'rounding floor of |g| (u)' },
    { field: 'failure', title: 'why', text: true }];
  return [element('p', {}, text),
          ...(audited.length > 0 ? [sortableTable(columns, audited, { name: 'audit', page: 20 }), element('p', { class: 'quiet' }, kUnitNote)] : [])];
}

function optionsContent() {
  const sets = new Map();
  for (const row of chosen) {
    if (row.verdict === 'skipped' && Object.keys(row.options ?? {}).length === 0) continue;
    const text = Object.entries(row.options ?? {}).map(([name, value]) => `${name}=${textOf(value)}`);
    const key = JSON.stringify([row.solver, text]);
    if (!sets.has(key)) sets.set(key, { solver: row.solver, options: text.join('  '), runs: 0 });
    sets.get(key).runs += 1;
  }
  const columns = [{ field: 'solver', title: 'solver as asked for', text: true },
                   { field: 'options', title: 'options as really used', text: true },
                   { field: 'runs', title: 'runs' }];
  return sortableTable(columns, [...sets.values()], { name: 'options', page: 60 });
}
