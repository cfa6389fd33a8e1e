// The figures of a folder that have their panels as numbers.

async function testPanels({ expect, settled }) {
  const numPanels = doc.pictures.reduce((sum, picture) => sum + (picture.panels?.length ?? 0), 0);
  const found = allPlots.filter(plot => plot.figure.closest('.panels'));
  expect('each panel is a plot', found.length === numPanels);
  const titles = found.map(plot => plot.title);
  expect('titles of panels differ', new Set(titles).size === titles.length);
  if (isOfSuite || doc.name === 'jobs') expect('panels are told apart by names', titles.every(title => !/\(\d+\)$/.test(title)));
  const saved = [], usual = window.download;
  window.download = (name, content) => saved.push([name, content]);
  for (const box of document.querySelectorAll('.panels')) {
    for (const button of box.querySelectorAll(':scope > .row button')) button.click();
  }
  window.download = usual;
  const given = doc.pictures.filter(picture => picture.panels)
    .flatMap(({ name, svg, data }) => [[name, svg], [name.replace(/svg$/, 'dat'), data]]).filter(([, text]) => text !== undefined);
  expect('pictures and data can be saved as they are', given.length === saved.length &&
    given.every(([name, text]) => saved.some(([file, content]) => file === name && content === text)));

  for (const picture of doc.pictures.filter(({ panels }) => panels)) {
    const stem = picture.name.replace(/\.svg$/, '');
    panelsOf()[stem].forEach((panel, place) => testPanel(stem, place, panel));
  }
  function testPanel(stem, place, panel) {
    const plot = found.find(({ caption }) => caption.textContent.startsWith(`Panel ${place + 1} of ${panelsOf()[stem].length} of ${stem}:`));
    expect(`${stem}, panel ${place + 1}: is there`, plot !== undefined);
    if (!plot?.drawn.spec) return;
    const isShown = (x, y) => isNumber(x) && isNumber(y) && (!panel.log_x || x > 0) && (!panel.log_y || y > 0);
    const wanted = panel.series.flatMap((series, k) => series.x.map((x, i) => [String(k), x, series.y[i]]))
      .filter(([, x, y]) => isShown(x, y));
    expect(`${plot.title}: all points that its axes can show`, wanted.length === plot.drawn.data.length &&
      wanted.every(([id, x, y], i) => plot.drawn.data[i].id === id && plot.drawn.data[i].px === x && plot.drawn.data[i].py === y));
    const { view } = plot.result;
    expect(`${plot.title}: axes as the picture has them`,
      (view.scale('x').type === 'log') === panel.log_x && (view.scale('y').type === 'log') === panel.log_y);
    const inside = (value, [low, high]) => value >= low && value <= high;
    expect(`${plot.title}: nothing lies outside`, wanted.every(([, x, y]) =>
      inside(x, view.scale('x').domain()) && (panel.is_share || inside(y, view.scale('y').domain()))));
    const unit = (scale, pixels) => (scale.domain()[1] - scale.domain()[0]) / pixels;
    const [across, up] = [unit(view.scale('x'), view.signal('width')), unit(view.scale('y'), view.signal('height'))];
    if (panel.equal_scale) expect(`${plot.title}: equal scale`, Math.abs(across / up - 1) < 1e-9);
    if (panel.is_share) expect(`${plot.title}: from 0 to 1`, view.scale('y').domain()[0] === 0 && view.scale('y').domain()[1] === 1.03);
    testLooksOf(plot, panel);
    if (panel.x_names.length > 0) {
      const texts = textsOf(view);
      expect(`${plot.title}: names along`, panel.x_names.every(name => texts.includes(name)));
    }
  }
  // Lines and marks of a plot as Vega has drawn them.
  function testLooksOf(plot, panel) {
    const drawn = new Map();  // colour and dash of each line, colour of each mark, by series
    const visit = mark => {
      for (const item of mark.items ?? []) {
        if (mark.marktype === 'group') item.items?.forEach(visit);
        else if (item.datum?.id !== undefined && item.tooltip === undefined) {
          if (!drawn.has(item.datum.id)) drawn.set(item.datum.id, []);
          drawn.get(item.datum.id).push([mark.marktype, item.stroke ?? item.fill, item.strokeDash, item.fill]);
        }
      }
    };
    visit(plot.result.view.scenegraph().root);
    panel.series.forEach((series, k) => {
      if (!plot.drawn.data.some(row => row.id === String(k))) return;
      // Solvers look as in all other plots.
      const isSolver = series.style === 'one_of_many' && allSolvers.includes(series.label);
      const items = drawn.get(String(k)) ?? [];
      const colour = isSolver ? colourOf(series.label) : kPanelPalettes[scheme][((series.color % 8) + 8) % 8];
      const types = new Set(items.map(([type]) => type));
      const wanted = { line: ['line'], dashed: ['line'], one_of_many: ['line'], line_points: ['line', 'symbol'],
                       points: ['symbol'], circles: ['symbol'] }[series.style];
      const hasMarks = series.style === 'one_of_many' && types.has('symbol');
      expect(`${plot.title}: style of ${series.label || k}`, wanted.every(type => types.has(type)) &&
        types.size === wanted.length + (hasMarks ? 1 : 0));
      expect(`${plot.title}: colour of ${series.label || k}`, items.every(([, painted]) => painted === colour));
      const lines = items.filter(([type]) => type === 'line');
      expect(`${plot.title}: dash of ${series.label || k}`, lines.every(([, , dash]) =>
        (series.style !== 'dashed' || dash?.join() === '6,4') &&
        (!isSolver || dash?.join() === lookOf(series.label, kDashes).join())));
      expect(`${plot.title}: rings of ${series.label || k}`, series.style !== 'circles' ||
        items.every(([, , , fill]) => !fill || fill === 'transparent'));
    });
  }
  function textsOf(view) {
    const texts = [];
    const visit = mark => (mark.items ?? []).forEach(item => {
      if (mark.marktype === 'group') item.items?.forEach(visit);
      else if (mark.marktype === 'text') texts.push(item.text);
    });
    visit(view.scenegraph().root);
    return texts;
  }
  await settled();
}
