// What inputs.py asks the page while it presses keys and moves the mouse.

const inputs = {
  visited: [],

  async begin() {
    for (const details of document.querySelectorAll('details')) details.open = true;
    for (const plot of allPlots) await plot.draw();
    await this.settled();
    document.addEventListener('focusin', event => this.visited.push(event.target));
  },
  // Once more: a plot that was being drawn may have been asked for again.
  async settled() {
    for (let k = 0; k < 2; ++k) await Promise.all(allPlots.map(plot => plot.isDone));
  },

  // All that a key may work on, in the order of the document.
  controls() {
    const all = [...document.querySelectorAll('a[href], button, select, input, summary, [tabindex="0"]')];
    return all.filter(node => !node.disabled && node.checkVisibility({ visibilityProperty: true }));
  },
  nameOf(node) {
    const of = node.closest('figure, fieldset, section, header, #filters');
    const words = (node.getAttribute('aria-label') ?? node.closest('label')?.textContent ?? node.textContent).trim();
    return `${node.tagName.toLowerCase()} "${words.slice(0, 40)}" of "${of?.querySelector('h3, legend, h2')?.textContent ?? ''}"`;
  },
  numControls() {
    this.expected = this.controls();
    this.visited.length = 0;
    document.activeElement.blur();
    getSelection().removeAllRanges();
    scrollTo(0, 0);
    return this.expected.length;
  },
  // '' or where Tab went another way.
  wrongTurn() {
    const length = Math.max(this.expected.length, this.visited.length);
    for (let k = 0; k < length; ++k) {
      const [wanted, came] = [this.expected[k], this.visited[k]];
      if (wanted !== came) {
        return `stop ${k + 1}: expected ${wanted ? this.nameOf(wanted) : 'the end'}, came to ${came ? this.nameOf(came) : 'nothing'}`;
      }
    }
    return '';
  },

  titles() {
    return allPlots.filter(plot => plot.drawn.spec && !plot.figure.closest('[hidden]')).map(plot => plot.title);
  },
  plot(title) { return allPlots.find(plot => plot.title === title); },

  // Marks of a plot that have something to tell, with their middles in pixels of the window.
  marks(title) {
    const { view } = this.plot(title).result;
    const canvas = this.plot(title).view.querySelector('canvas').getBoundingClientRect();
    const [[left, top], space, found] = [view.origin(), view.padding(), []];
    const visit = (mark, x, y) => {
      for (const item of mark.items ?? []) {
        if (mark.marktype === 'group') {
          for (const child of item.items ?? []) visit(child, x + (item.x ?? 0), y + (item.y ?? 0));
        } else if (mark.marktype === 'symbol' && item.tooltip) {
          found.push({ x: canvas.x + space.left + left + x + item.x,
                       y: canvas.y + space.top + top + y + item.y, datum: item.datum });
        }
      }
    };
    visit(view.scenegraph().root, 0, 0);
    return found.filter(({ x, y }) => x > canvas.left && x < canvas.right && y > canvas.top && y < canvas.bottom);
  },
  // Places of some marks, spread over the plot.
  places(title) {
    this.plot(title).view.scrollIntoView({ block: 'center' });
    const all = this.marks(title).filter(({ x, y }) => y > 0 && y < innerHeight && x > 0 && x < innerWidth);
    return [0.1, 0.5, 0.9].map(part => all[Math.floor(part * all.length)]).map(mark => mark && [mark.x, mark.y]);
  },
  tooltip() {
    const node = document.querySelector('#vg-tooltip-element.visible');
    return node === null ? null : [...node.querySelectorAll('tr')].map(line => [...line.cells].map(cell => cell.textContent.trim()));
  },
  // Whether the tooltip tells the values of a mark under the pointer: its radius is at most 6 pixels.
  tells(title, [x, y]) {
    const lines = this.tooltip();
    if (!lines || lines.length < 3) return false;
    const near = this.marks(title).filter(mark => Math.hypot(mark.x - x, mark.y - y) <= 6);
    const isShown = value => lines.some(([, text]) => text === String(value) || (typeof value === 'number' &&
      [3, 4, 5].map(digits => value.toPrecision(digits)).concat(value.toFixed(3))
        .some(rounded => Number(rounded) === Number(text.replace('−', '-')))));
    return near.some(({ datum }) => [datum.series ?? datum.solver, datum.at ?? datum.px, datum.py].every(isShown));
  },
};
