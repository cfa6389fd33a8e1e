// What the tests see of plots and colours.

// Whether the names of both axes lie within the picture.
function areTitlesWhole(plot) {
  const { view } = plot.result, space = view.padding(), titles = [];
  const [width, height] = [plot.view.querySelector('canvas').clientWidth, plot.view.querySelector('canvas').clientHeight];
  const visit = (mark, x, y) => {
    for (const item of mark.items ?? []) {
      if (mark.role === 'axis-title') titles.push([item.bounds.x1 + x, item.bounds.y1 + y, item.bounds.x2 + x, item.bounds.y2 + y]);
      if (mark.marktype === 'group') for (const child of item.items) visit(child, x + (item.x ?? 0), y + (item.y ?? 0));
    }
  };
  visit(view.scenegraph().root, view.origin()[0] + space.left, view.origin()[1] + space.top);
  return titles.length === 2 && titles.every(([left, top, right, bottom]) =>
    left >= 0 && top >= 0 && right <= width && bottom <= height);
}

// The names in a plot's legend as Vega has drawn them; what is longer than its limit is cut.
function legendLabels(view) {
  const found = [];
  const visit = (mark, isLegend) => (mark.items ?? []).forEach(item => {
    if (mark.marktype === 'group') item.items?.forEach(child => visit(child, isLegend || mark.role === 'legend'));
    else if (isLegend && mark.role === 'legend-label') found.push(item);
  });
  visit(view.scenegraph().root, false);
  return found;
}

function hasInk(canvas) {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const colours = new Set();
  for (let k = 0; k < data.length; k += 4) colours.add((data[k] << 16) | (data[k + 1] << 8) | data[k + 2]);
  return colours.size > 5;
}

function contrast(a, b) {  // WCAG 2.1
  const light = colour => {
    const probe = element('span', { style: `color: ${colour}` });
    document.body.append(probe);
    const parts = getComputedStyle(probe).color.match(/[\d.]+/g).slice(0, 3).map(Number);
    probe.remove();
    const [r, g, b] = parts.map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}
