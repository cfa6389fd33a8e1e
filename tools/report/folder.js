// The sections that are not made of runs: verdicts on claims, pictures, tables, the build.

// Said where the page also has runs, which the filters choose from.
const ofAllRuns = () => rows.length === 0 ? null
  : element('p', { class: 'quiet' }, 'Of all runs of the folder: the filters do not change these.');

// The pages of reproductions; returns the pictures and tables that none of them shows.
function addPages() {
  const pictures = new Map(doc.pictures.map(picture => [picture.name, picture]));
  const tables = new Map(doc.tables.map(table => [table.name, table]));
  for (const page of doc.pages) addPage(page, pictures, tables);
  return { pictures, tables };
}

function addFolderSections({ pictures, tables }) {
  if (doc.bench_notes.length > 0) {
    const points = doc.bench_notes.filter(line => line.startsWith('- '));
    addSection('Notes of the benchmark', element('div', {}, ofAllRuns(),
      ...doc.bench_notes.filter(line => !line.startsWith('- ')).map(line => element('p', {}, line)),
      element('ul', {}, ...points.map(line => element('li', {}, line.slice(2))))));
  }
  if (pictures.size > 0) {
    addSection('Pictures', element('div', {}, ofAllRuns(),
      element('div', { class: 'plots' }, ...[...pictures.values()].map(picture =>
        figureOf(picture, 'As drawn when the folder was written. Data: what is plotted, in blocks, a line each.')))));
  }
  if (tables.size > 0) {
    addSection('Tables', element('div', {}, ofAllRuns(), ...[...tables.values()].map(table =>
      element('details', { open: tables.size <= 3 }, element('summary', {}, table.name),
              folderTable(table)))));
  }
  addBuild();
}

function addPage(page, pictures, tables) {
  const sections = page.sections.filter(section => section.claims.length > 0);
  const list = sections.flatMap(section =>
    section.claims.map(claim => ({ experiment: section.title, ...claim })));
  const verdict = row => element('span', {
    class: 'badge ' + (row.verdict === 'holds' ? 'good' : row.verdict === 'does not hold' ? 'bad' : ''),
  }, row.verdict);
  const columns = [{ field: 'experiment', title: 'experiment', text: true },
                   { field: 'quote', title: 'claim', text: true },
                   { field: 'verdict', title: 'verdict', text: true, cell: verdict },
                   { field: 'because', title: 'because', text: true }];
  const of = doc.pages.length > 1 ? `: ${page.title}` : '';
  addSection('Verdicts' + of, element('div', {}, element('p', {}, page.title),
                                 sortableTable(columns, list, { name: 'verdicts' + of })));
  const experiments = sections.map(section => element('details', {},
    element('summary', {}, section.title),
    ...section.claims.flatMap(claim => [
      element('blockquote', {}, claim.quote),
      element('p', {}, verdict(claim), ': ' + claim.because),
      element('p', { class: 'quiet' }, 'Rule: ' + claim.rule)]),
    ...section.pictures.filter(({ name }) => pictures.has(name)).map(({ name, caption }) => {
      const figure = figureOf(pictures.get(name), caption);
      pictures.delete(name);
      return figure;
    }),
    ...section.tables.filter(name => tables.has(name)).flatMap(name => {
      const table = tables.get(name);
      tables.delete(name);
      return [element('h3', {}, name), folderTable(table)];
    })));
  addSection('Experiments' + of, element('div', {}, ...experiments));
}

// As an image: scripts in a picture do not run. Zoomed by its width in a box that scrolls; vectors
// stay sharp.
function pictureOf(picture, caption = '') {
  const source = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(picture.svg);
  const image = element('img', { src: source, alt: caption || `Picture ${picture.name}`,
                                 loading: 'lazy', draggable: 'false' });
  let scale = 1;
  const box = element('div', { class: 'picture', tabindex: 0, role: 'group',
    'aria-label': `${picture.name}. Keys: plus and minus zoom, arrows move, 0 shows all.` }, image);
  // The point of the picture in the middle of the box, or under the pointer, stays where it is.
  const zoom = (factor, x = box.clientWidth / 2, y = box.clientHeight / 2) => {
    const next = Math.min(16, Math.max(1, scale * factor)), ratio = next / scale;
    const [left, top] = [(box.scrollLeft + x) * ratio - x, (box.scrollTop + y) * ratio - y];
    // Its height stays, so that the page does not jump.
    box.style.height = next > 1 ? `${box.style.height ? box.clientHeight + 2 : box.offsetHeight}px` : '';
    scale = next;
    image.style.width = scale > 1 ? `${100 * scale}%` : '';
    image.style.maxWidth = scale > 1 ? 'none' : '';
    box.scrollTo(left, top);
  };
  const move = (x, y) => box.scrollBy(x * box.clientWidth, y * box.clientHeight);
  const keys = { '+': () => zoom(1.6), '=': () => zoom(1.6), '-': () => zoom(1 / 1.6), 0: () => zoom(0),
                 ArrowLeft: () => move(-0.15, 0), ArrowRight: () => move(0.15, 0),
                 ArrowUp: () => move(0, -0.15), ArrowDown: () => move(0, 0.15) };
  box.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in keys)) return;
    if (scale === 1 && event.key.startsWith('Arrow')) return;  // scrolls the page
    keys[event.key]();
    event.preventDefault();
  });
  box.addEventListener('wheel', event => {
    if (!event.ctrlKey) return;
    const place = box.getBoundingClientRect();
    zoom(event.deltaY < 0 ? 1.25 : 0.8, event.clientX - place.left, event.clientY - place.top);
    event.preventDefault();
  }, { passive: false });
  box.addEventListener('dblclick', () => zoom(0));
  box.addEventListener('pointermove', event => {
    if (event.buttons === 1 && event.pointerType === 'mouse') box.scrollBy(-event.movementX, -event.movementY);
  });
  const button = (text, onclick, label) => element('button', { type: 'button', onclick, 'aria-label': label }, text);
  const data = picture.data === undefined ? null : button('Data', () =>
    download(picture.name.replace(/\.svg$/, '.dat'), picture.data, 'text/plain'));
  return element('figure', {}, element('h3', {}, picture.name), box,
    element('div', { class: 'row' }, button('+', () => zoom(1.6), 'Zoom in'),
      button('−', () => zoom(1 / 1.6), 'Zoom out'), button('Show all', () => zoom(0)), data,
      button('SVG', () => download(picture.name, picture.svg, 'image/svg+xml')),
      button('PNG', () => savePicturePng(image, picture.name))),
    element('figcaption', {}, caption));
}

function savePicturePng(image, name) {
  const canvas = element('canvas', { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
  const context = canvas.getContext('2d');
  context.fillStyle = '#fff';
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  download(name.replace(/\.svg$/, '.png'), canvas.toDataURL('image/png'), 'image/png');
}

function folderTable(table) {
  const columns = table.columns.map((title, k) => ({ field: String(k), title }));
  const list = table.rows.map(values => ({ ...values }));
  const node = sortableTable(columns, list, { name: table.name.replace(/\.csv$/, ''), page: 50 });
  if (table.rows.length < table.num_rows) {
    node.append(element('p', { class: 'quiet' },
      `The first ${table.rows.length} of ${table.num_rows} rows; the folder has them all.`));
  }
  return node;
}

function addBuild() {
  const fields = ['mode', 'gradient_tolerance', 'max_iterations', 'max_seconds', 'native_step',
                  'native_gradient', 'seed', 'threads', 'compile', 'version', 'commit', 'compiler'];
  const seen = Object.fromEntries(fields.map(field =>
    [field, [...new Set(rows.map(row => row[field]).filter(value => value !== undefined).map(textOf))]
      .join(' | ')]).filter(([, text]) => text !== ''));
  if (rows.length === 0 && !doc.manifest) return;
  addSection('How it was run', element('div', {},
    rows.length > 0 ? definitions(seen) : null,
    doc.manifest ? element('details', {}, element('summary', {}, 'manifest.json'),
      element('pre', { tabindex: 0 }, JSON.stringify(doc.manifest, null, 2))) : null));
}
