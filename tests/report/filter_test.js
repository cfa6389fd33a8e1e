// What the filters leave: the player and the lists of problems follow them, and where nothing of a kind is
// left a sentence stands alone. Then what the tables of runs tell them apart by.

const kRunSections = ['summary', 'convergence', 'profiles', 'player', 'runs', 'failures', 'claim_and_audit', 'options_that_ran'];
const isShown = node => node.checkVisibility();
const shownIn = (section, selector) => [...document.getElementById(section).querySelectorAll(selector)].filter(isShown);

async function testFollowing(reader) {
  const { expect, all, boxesOf, drawAll } = reader;
  const only = wanted => boxesOf('problem').forEach(box => { if (box.checked !== wanted(box.value)) box.click(); });
  await testNothing(reader);
  for (const problem of new Set([allProblems.at(-1), allProblems.at(0)])) {
    all('[data-filter="problem"] button')[1].click();
    only(name => name === problem);
    await drawAll();
    await testOne(reader, problem);
  }
  // The problem that is shown goes out; where the player shows one, that too.
  only(() => true);
  const shown = document.querySelector('#player select') ?? document.querySelector('#convergence select');
  const gone = doc.groups[Number(shown.value)].problem;
  only(name => name !== gone);
  await drawAll();
  if (allProblems.length > 1) {
    expect('a problem that is filtered out is shown no more', ['convergence', 'player'].every(section =>
      shownIn(section, 'label:first-child > select').every(choice => doc.groups[Number(choice.value)].problem !== gone)));
  }
  only(() => true);
  await testKinds(reader, only);
  only(() => true);
  await drawAll();
  expect('what has nothing to draw has no buttons', allPlots.every(plot => !plot.drawn.spec === plot.buttons.hidden &&
    (plot.drawn.spec || !isShown(plot.buttons))));
}

async function testNothing({ expect, all, drawAll }) {
  all('[data-filter="problem"] button')[1].click();
  await drawAll();
  for (const section of kRunSections) {
    const said = shownIn(section, 'p').map(node => node.textContent);
    expect(`${section} without runs: one sentence: ${said.join(' | ')}`, said.length === 1);
    expect(`${section} without runs: nothing else`, shownIn(section, 'figure, button, select, table').length === 0);
  }
  all('[data-filter="problem"] button')[0].click();
  await drawAll();
}

async function testOne({ expect, settled }, problem) {
  const groups = new Set(rows.filter(row => row.problem === problem).map(row => row.group));
  const withCurves = new Set(rows.filter(row => row.problem === problem && hasCurve(row)).map(row => row.group));
  const offered = section => [...(shownIn(section, 'label:first-child > select')[0]?.options ?? [])].map(option => Number(option.value));
  const isSame = (list, wanted) => list.length === wanted.size && list.every(group => wanted.has(group));
  expect(`only ${problem}: convergence offers it alone`, isSame(offered('convergence'), groups));
  expect(`only ${problem}: the player offers it alone`, isSame(offered('player'), withCurves));
  const plot = playerPlot();
  if (!plot) return;
  if (withCurves.size === 0) {
    expect(`only ${problem}: the player says that it has no curve`, shownIn('player', 'figure').length === 0 &&
      shownIn('player', 'p').map(node => node.textContent).join() === 'No run that passes the filters has kept its iterates.');
    return;
  }
  const button = [...document.querySelectorAll('#player button')].find(node => node.textContent === 'Last');
  button.click();
  await settled();
  const runs = rows.filter(row => row.group === Number(document.querySelector('#player select').value) && hasCurve(row));
  const drawn = new Set((plot.drawn.data ?? []).map(row => row.solver));
  expect(`only ${problem}: the player draws its runs to their ends`, runs[0].problem === problem &&
    runs.slice(0, kMostPanels).every(row => drawn.has(row.solver)) && Number(document.querySelector('#player input[type="range"]').value) ===
      Math.max(...runs.slice(0, kMostPanels).flatMap(row => curves().runs[row.key].iterations)));
}

// The problems of one kind of parameters alone: the plots of the others go.
async function testKinds({ expect, drawAll }, only) {
  if (allKinds.length < 2) return;
  for (const kind of allKinds) {
    const left = new Set(rows.filter(row => kindOf(row) === kind).map(row => row.problem));
    only(name => left.has(name));
    await drawAll();
    const numGroups = new Set(chosen.map(row => row.group)).size, applies = chosen.some(row => row.verdict !== 'skipped');
    if (numGroups < 2) continue;
    const titles = shownIn('profiles', 'figure h3').map(node => node.textContent);
    expect(`only ${kind} parameters: no other profiles`, (titles.length > 0) === applies &&
      titles.every(title => title.includes(`${kind} parameters`)));
    expect(`only ${kind} parameters: a sentence for each other kind`, shownIn('profiles', '.none').length === allKinds.length - (applies ? 1 : 0));
  }
}

function testTables({ expect }) {
  const titlesOf = section => [...document.querySelectorAll(`#${section} thead th`)].map(cell => cell.textContent);
  const differ = field => new Set(rows.map(row => String(row[field] ?? ''))).size > 1;
  const apart = [['terms', 'terms'], ['data_seed', 'data seed'], ['start_seed', 'start seed'],
                 ['seed', 'seed of the solver'], ['repetition', 'repetition']].filter(([field]) => differ(field));
  const isBad = row => row.verdict === 'failed' || row.verdict === 'refuted';
  const tables = [['runs', true], ['failures', rows.some(isBad)],
                  ['claim_and_audit', rows.some(row => typeof row.verified === 'boolean')]].filter(([, isThere]) => isThere);
  for (const [section] of tables) {
    expect(`${section}: what tells runs apart: ${apart.map(([, title]) => title).join(', ')}`,
      apart.every(([, title]) => titlesOf(section).includes(title)));
  }
  if (doc.bench_notes.length > 0) {
    expect('no two runs are told apart by nothing', new Set(rows.map(row =>
      [row.problem, row.solver, ...apart.map(([field]) => row[field])].join('|'))).size === rows.length);
  }
  const head = document.querySelector('#runs thead');
  expect(`the header of Runs is low: ${head.offsetHeight} pixels`, head.offsetHeight < 70);
  const cut = rows.filter(row => ['iteration_limit', 'time_limit'].includes(row.stop) && !row.message && isBad(row));
  const [failures] = [failuresContent()].flat(), more = failures.querySelector('.row button');
  while (more && !more.hidden && more.textContent.startsWith('Show')) more.click();
  expect('runs that hit a limit say which', cut.every(row => failures.textContent.includes(row.stop === 'time_limit'
    ? `limit of ${show(row.max_seconds)} s` : `limit of ${show(row.max_iterations)} iterations`)));
  const place = titlesOf('runs').indexOf('time (s)');
  const times = [...document.querySelectorAll('#runs tbody tr')].map(line => line.cells[place]?.textContent ?? '–');
  if (rows.every(isOverlapped)) expect('times of overlapped runs are not told', times.every(text => text === '–'));
  const numOverlapped = rows.filter(isOverlapped).length;
  expect('and how many they are', numOverlapped === 0 ||
    document.querySelector('#runs').textContent.includes(`leave out ${counted(numOverlapped, 'run')} that overlapped`));
  const named = ['pictures', 'tables', 'notes_of_the_benchmark'].map(id => document.getElementById(id)).filter(Boolean);
  expect('sections that the filters do not change say so', named.every(section =>
    section.textContent.includes('the filters do not change these')));
}
