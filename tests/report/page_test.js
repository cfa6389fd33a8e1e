// Put at the end of the page under test: tries what a reader does and tells the verdict to the page
// around, which stands in a frame.
(async () => {
  const results = [];
  const expect = (what, holds) => results.push((holds ? 'ok ' : 'FAILED ') + what);
  const all = selector => [...document.querySelectorAll(selector)];
  const settled = async () => {
    // Once more: a plot that was being drawn may have been asked for again.
    for (let k = 0; k < 2; ++k) await Promise.all(allPlots.map(plot => plot.isDone));
  };
  const drawAll = async () => {
    for (const plot of allPlots) await plot.draw();
    await settled();
  };
  const change = (node, value) => { node.value = value; node.dispatchEvent(new Event('change')); };
  const selectOf = label => all('label').find(l => l.textContent.startsWith(label))?.querySelector('select');
  const boxesOf = kind => all(`[data-filter="${kind}"] input[type="checkbox"]`);
  const reader = { expect, all, change, selectOf, settled, boxesOf, drawAll };
  const visible = plot => !plot.figure.closest('[hidden]');

  try {
    await drawAll();
    expect('the page is ready', document.documentElement.dataset.ready === 'yes');
    expect('no text of the data became an element', !document.querySelector('b, main script, img[onerror]'));
    expect('no wider than the window', document.documentElement.scrollWidth <= innerWidth);
    for (const details of all('details')) details.open = true;
    expect('nor with all opened', document.documentElement.scrollWidth <= innerWidth);
    expect('each figure says what it shows', all('figure').every(figure =>
      figure.querySelector('figcaption').textContent.length > 20));
    const ids = all('[id]').map(node => node.id);
    expect('no id stands twice', new Set(ids).size === ids.length);
    for (const link of all('#contents a')) {
      expect(`section ${link.hash}`, document.querySelector(link.hash)?.children.length === 2);
    }
    await drawAll();
    await testPlots();
    if (rows.length > 0) await testRuns();
    if (doc.pages.length > 0) testReproduction();
    await testPanels(reader);
    await testPictures();
  } catch (error) {
    expect('no exception: ' + error.stack, false);
  }
  expect('nothing on the console: ' + [...new Set(said)].join(' | '), said.length === 0);
  const failed = results.filter(line => line.startsWith('FAILED')).length;
  parent.postMessage(`${results.join('\n')}\n` +
    `page test: ${innerWidth} px, ${systemDark.matches ? 'dark' : 'light'}: ` +
    `${results.length - failed} passed, ${failed} failed\n`, '*');

  async function testPlots() {
    for (const plot of allPlots.filter(visible)) {
      const box = plot.view.querySelector('canvas');
      // Where no two runs end in one minimum; profile_test.js looks at that.
      if (plot.title.startsWith('Pair profile') && !plot.drawn.spec) continue;
      expect(`${plot.title}: drawn`, box !== null && box.clientWidth > 100);
      if (!box) continue;
      expect(`${plot.title}: not wider than its place`, box.clientWidth <= plot.view.clientWidth + 1);
      expect(`${plot.title}: not blank`, hasInk(box));
      expect(`${plot.title}: its label tells the keys`, plot.view.getAttribute('aria-label').startsWith(plot.title) &&
        plot.view.getAttribute('aria-label').includes('plus and minus zoom'));
      expect(`${plot.title}: says what is plotted`, plot.caption.textContent.length > 40);
      const titles = Object.values(plot.drawn.columns);
      expect(`${plot.title}: no two columns have one name`, new Set(titles).size === titles.length);
      expect(`${plot.title}: data`, plot.csv().split('\n').length > 2);
      expect(`${plot.title}: SVG`, (await plot.result.view.toSVG()).startsWith('<svg'));
      expect(`${plot.title}: PNG`, (await plot.result.view.toImageURL('png')).startsWith('data:image/png'));
      const names = legendLabels(plot.result.view);
      expect(`${plot.title}: names in the legend are whole under the mouse`, names.every(item =>
        item.tooltip === item.text && item.mark.interactive && item.limit >= Math.min(170, 7 * item.text.length)) &&
        (names.length > 0 || !plot.title.startsWith('Performance profile')));
      plot.toggleTable();
      expect(`${plot.title}: values`, plot.table.querySelectorAll('tbody tr').length > 0);
      plot.toggleTable();
    }
    await testZoom();
  }

  async function testRuns() {
    testVerdicts();
    testLooks();
    testProfiles();
    await testPairProfiles(reader);
    await testAgainstTables(reader);
    await testWorkUnits(reader);
    testTables(reader);
    if (doc.bench_notes.length > 0) {
      testBench(reader);
      await testCurvesOfBench(reader);
    }
    await testChoices();
    await testFilters();
    await testFollowing(reader);
    await testPlayer(reader);
    await testSchemes();
    testSorting();
    testButtonsHaveNames();
  }

  function testVerdicts() {
    const belied = rows.filter(row => (row.findings ?? []).includes('claim_fails') && row.stop !== 'skipped');
    expect('what bench finds belied is refuted', belied.every(row => row.verdict === 'refuted'));
    if (doc.name === 'made_up') expect('some runs are belied', belied.length > 0);
    const failures = document.querySelector('#failures').textContent;
    expect('and stands under Failures', belied.length === 0 || failures.includes('refuted'));
  }

  function testLooks() {
    const looks = new Set(allSolvers.map(solver => colourOf(solver) + lookOf(solver, kDashes)));
    expect('solvers look different', looks.size === Math.min(allSolvers.length, 48));
    const marked = allPlots.flatMap(plot => plot.drawn.data ?? []).filter(row => row.mark);
    expect('those beyond the first eight have marks', allSolvers.length <= 8
      ? marked.length === 0 : marked.length > 0 && marked.every(row => allSolvers.indexOf(row.solver) >= 8));
  }

  // Of each kind of parameters, with the solvers that apply to it alone.
  function testProfiles() {
    const kinds = [...new Set(rows.map(row => row.parameter_kind).filter(Boolean))];
    for (const plot of allPlots.filter(p => p.title.startsWith('Performance profile') && p.drawn.data)) {
      const kind = kinds.find(name => plot.title.includes(` ${name} parameters`));
      if (kind === undefined) continue;
      const applying = new Set(rows.filter(row => row.parameter_kind === kind && row.stop !== 'skipped')
        .map(row => row.solver));
      const drawn = new Set(plot.drawn.data.map(row => row.solver));
      expect(`${plot.title}: the solvers that apply`, drawn.size === applying.size &&
        [...drawn].every(solver => applying.has(solver)));
      const ofKind = rows.filter(row => kindOf(row) === kind && hasTarget(row.group, 1e-6));
      const numInstances = list => new Set(list.map(row => row.group)).size;
      const isMissing = solver => numInstances(ofKind.filter(row => row.solver === solver)) < numInstances(ofKind);
      const said = plot.caption.textContent.match(/whose cost is known, all \d+, but (.*?)\.( |$)/)?.[1] ?? '';
      expect(`${plot.title}: says who was not run on all`,
        [...drawn].every(solver => isMissing(solver) === ` ${said}`.includes(` ${solver} on `)));
    }
    expect('a profile for each kind of parameters', kinds.every(kind =>
      allPlots.some(plot => plot.title.startsWith(`Performance profile, ${kind} parameters`))));
  }

  async function testZoom() {
    for (const plot of allPlots.filter(p => visible(p) && p.drawn.zooms)) {
      const before = plot.domains();
      plot.view.dispatchEvent(new KeyboardEvent('keydown', { key: '+', bubbles: true }));
      await plot.result.view.runAsync();
      const near = plot.domains();
      expect(`${plot.title}: + zooms in`, near.px[0] > before.px[0] && near.px[1] < before.px[1] &&
                                          near.py[1] < before.py[1]);
      plot.view.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
      await plot.result.view.runAsync();
      expect(`${plot.title}: arrows move`, plot.domains().px[0] > near.px[0]);
      plot.view.dispatchEvent(new KeyboardEvent('keydown', { key: '0', bubbles: true }));
      await plot.result.view.runAsync();
      const after = plot.domains();
      expect(`${plot.title}: 0 shows all`, after.px[0] === before.px[0] && after.py[1] === before.py[1]);
    }
  }

  async function testChoices() {
    const plot = allPlots.find(p => p.title === 'Convergence');
    expect('profiles begin with evaluations', selectOf('Measured by').value === 'evaluations');
    for (const along of [...selectOf('Along').options].map(option => option.value).reverse()) {
      change(selectOf('Along'), along);
      await drawAll();
      const number = plot.drawn.data?.length ?? 0;
      // Where all runs overlapped there is no time to draw.
      const isKnown = !kAlong[along].isTime || rows.some(row => row.group === 0 && traceOf(row) && !isOverlapped(row));
      expect(`convergence along ${along}`, (number > 0) === isKnown && plot.caption.textContent.includes(kAlong[along].title));
      for (const each of allPlots.filter(p => visible(p) && p.drawn.zooms && selectOf('Along').closest('section').contains(p.figure))) {
        expect(`${each.title} along ${along}: names of axes are whole`, areTitlesWhole(each));
      }
      const isLeftOut = rows.some(row => isOverlapped(row) && row.group === 0 && traceOf(row));
      if (kAlong[along].isTime && isLeftOut) {
        expect('overlapped runs are left out, and that is said', plot.caption.textContent.includes('overlapped') &&
          (plot.drawn.data ?? []).every(point => !rows.some(row => row.key === point.key && isOverlapped(row))));
      }
    }
    for (const up of ['excess', 'energy', 'gradient', 'gap']) {
      change(selectOf('Up'), up);
      await drawAll();
      expect(`convergence up ${up}`, plot.drawn.data.length > 0);
    }
    for (const measure of [...selectOf('Measured by').options].map(option => option.value).reverse()) {
      change(selectOf('Measured by'), measure);
      await drawAll();
      for (const each of allPlots.filter(p => visible(p) && p.drawn.zooms && selectOf('Measured by').closest('section').contains(p.figure))) {
        expect(`${each.title} by ${measure}: names of axes are whole`, areTitlesWhole(each));
      }
    }
    const starts = plot.drawn.data.filter(point => point.iteration === 0);
    expect('the gap begins at 1', starts.every(point => Math.abs(point.py - 1) < 1e-5));
  }

  async function testFilters() {
    const solver = allSolvers[0];
    const [box] = boxesOf('solver');
    box.click();
    await drawAll();
    expect('the solver filter takes its runs out', chosen.every(row => row.solver !== solver) &&
      chosen.length === rows.filter(row => row.solver !== solver).length);
    expect('filtered runs leave the plots', allPlots.every(plot =>
      !plot.drawn.data || plot.drawn.data.every(row => row.solver !== solver)));
    expect('filtered runs leave the tables',
      all('#summary tbody tr').every(row => row.cells[0].textContent.trim() !== solver));
    box.click();
    const problem = boxesOf('problem')[0];
    problem.click();
    await drawAll();
    expect('the problem filter', chosen.every(row => row.problem !== problem.value));
    problem.click();
    const term = boxesOf('term')[0];
    term.click();
    expect('the term filter', chosen.every(row => row.termList.some(t => t !== term.value)));
    term.click();
    expect('all runs are back', chosen.length === rows.length);
    all('[data-filter="problem"] button')[1].click();
    await drawAll();
    expect('no run at all is no error', chosen.length === 0);
    all('[data-filter="problem"] button')[0].click();
    await drawAll();
  }

  async function testSchemes() {
    for (const wanted of ['light', 'dark', 'system']) {
      document.getElementById('scheme').click();
      await drawAll();
      if (wanted === 'system') continue;
      expect(`${wanted} scheme`, scheme === wanted && document.documentElement.dataset.scheme === wanted);
      const back = getComputedStyle(document.body).backgroundColor, text = getComputedStyle(document.body).color;
      expect(`${wanted} scheme: contrast of text`, contrast(back, text) >= 7);
      expect(`${wanted} scheme: contrast of lines`, kPalettes[scheme].every(colour =>
        contrast(back, colour) >= 2.5));
    }
  }

  function testSorting() {
    const table = document.querySelector('#runs table');
    const place = [...table.tHead.rows[0].cells].findIndex(cell => cell.textContent === 'iterations');
    const header = table.tHead.rows[0].cells[place];
    for (const sign of [1, -1]) {
      header.querySelector('button').click();
      const values = [...table.tBodies[0].rows].map(row => row.cells[place].textContent)
        .filter(text => text !== '–').map(Number);
      expect(`runs sorted by iterations, ${header.getAttribute('aria-sort')}`,
        values.length > 1 && values.every((v, k) => k === 0 || sign * (v - values[k - 1]) >= 0));
    }
  }

  function testButtonsHaveNames() {
    expect('each button and field has a name', all('button, select, input').every(node =>
      (node.textContent.trim() || node.getAttribute('aria-label') || node.closest('label')?.textContent.trim())));
    expect('nothing takes the focus out of order', all('[tabindex]').every(node => node.tabIndex <= 0));
  }

  async function testPictures() {
    const saved = [], usual = window.download;
    window.download = (name, content) => saved.push([name, content]);
    const figures = all('figure').filter(figure => figure.querySelector('.picture'));
    expect('each picture is shown once', figures.length === doc.pictures.filter(picture => !picture.panels).length);
    for (const figure of figures) {
      const picture = doc.pictures.find(({ name }) => name === figure.querySelector('h3').textContent);
      const box = figure.querySelector('.picture'), image = box.querySelector('img');
      image.loading = 'eager';
      await image.decode();
      const press = key => box.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
      const width = () => image.getBoundingClientRect().width, before = width(), place = box.offsetHeight;
      press('+');
      press('+');
      expect(`${picture.name}: + zooms in`, width() > 1.5 * before && Math.abs(box.offsetHeight - place) <= 1);
      const left = box.scrollLeft;
      press('ArrowRight');
      expect(`${picture.name}: arrows move`, box.scrollLeft > left);
      press('0');
      expect(`${picture.name}: 0 shows all`, Math.abs(width() - before) <= 1);
      const button = [...figure.querySelectorAll('button')].find(b => b.textContent === 'Data');
      button?.click();
      expect(`${picture.name}: its data`, (button !== undefined) === (picture.data !== undefined) &&
        (!button || (saved.at(-1)[0].endsWith('.dat') && saved.at(-1)[1] === picture.data)));
    }
    window.download = usual;
  }

  function testReproduction() {
    expect('each claim has its verdict', all('#verdicts tbody tr').length ===
      doc.pages[0].sections.reduce((sum, section) => sum + section.claims.length, 0));
    expect('verdicts are those of the page', doc.pages[0].sections.every(section => section.claims.every(claim =>
      ['holds', 'holds in part', 'does not hold', 'undecided'].includes(claim.verdict) && claim.rule !== '')));
    expect('pictures are put in', all('img').every(image => image.src.startsWith('data:')));
    expect('what is plotted is there', doc.pictures.every(picture => picture.data?.length > 0));
    expect('all figures are plots', doc.pictures.every(picture => picture.panels?.length > 0));
    expect('tables are shown', all('#experiments table, #tables table').length >= doc.tables.length);
  }
})();
