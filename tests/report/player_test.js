// The player on the page, against what the folder says of its runs.

const hasCurve = row => row.key in curves().runs;
const playerPlot = () => allPlots.find(plot => plot.title === 'Curves side by side');
const chosenGroup = () => document.querySelector('#player select').value;

async function testPlayer({ expect, all, settled }) {
  const plot = playerPlot();
  expect('there is a player where there are curves', Boolean(plot) === rows.some(hasCurve));
  if (!plot) return;
  const button = text => all('#player button').find(b => b.textContent === text);
  button('First').click();
  await settled();
  const first = JSON.stringify(plot.drawn.data);
  expect('the player begins at iteration 0', plot.drawn.data.every(row => row.iteration === 0));
  button('Next').click();
  expect('it steps', JSON.stringify(plot.drawn.data) !== first);
  button('Last').click();
  expect('it goes to the end', Number(all('#player input[type="range"]')[0].value) > 0);
  const curve = plot.drawn.data.filter(row => row.kind === 'curve');
  expect('curves are drawn', curve.length > 0 && curve.every(row => Number.isFinite(row.px)));
  testEnds({ expect }, plot.drawn.data);
}

// The farthest data point is as far from the curve as the run says of its end. The curve is known at
// places a step apart, by control points that are rounded to a unit. Made-up runs say nothing true of
// their distance, but end at the data.
function testEnds({ expect }, drawn) {
  const apart = (a, b) => Math.hypot(a.px - b.px, a.py - b.py);
  // The first run of each solver has its name alone for the name of its panel.
  const ends = rows.filter(row => String(row.group) === chosenGroup() && hasCurve(row)).slice(0, kMostPanels)
    .filter((row, k, list) => list.findIndex(other => other.solver === row.solver) === k)
    // A curve that has gone too far is none any more: it is not drawn.
    .filter(row => isNumber(row.max_orthogonal) && !curves().runs[row.key].points.at(-1).includes(null));
  expect('runs say how far from the data they end', ends.length > 0);
  for (const row of ends) {
    const of = kind => drawn.filter(point => point.panel === row.solver && point.kind === kind);
    const curve = of('curve'), data = of('point');
    const far = Math.max(...data.map(point => Math.min(...curve.map(place => apart(place, point)))));
    const step = Math.max(...curve.slice(1).map((place, k) => apart(place, curve[k])));
    const { unit } = curves().runs[row.key], size = Math.max(...data.map(point => apart(point, data[0])));
    // Of many data points the page has some, and perhaps not the farthest one.
    const isWhole = settingOf(row).points.length === settingOf(row).num_points;
    const [least, most] = doc.name === 'made_up' ? [0, 0.05 * size]
      : [isWhole ? row.max_orthogonal - unit : 0, row.max_orthogonal + step / 2 + unit];
    expect(`the last curve of ${row.solver} is ${far} from the data, between ${least} and ${most}`,
      far >= least && far <= most);
  }
}

async function testCurvesOfBench({ expect, change, settled }) {
  expect('each first repetition has its curve, and no other', rows.every(row =>
    hasCurve(row) === (row.repetition === 1 && typeof row.iterations === 'number')));
  expect('from the start to the end', rows.filter(hasCurve).every(row => {
    const { iterations } = curves().runs[row.key];
    return iterations[0] === 0 && iterations.at(-1) === row.iterations;
  }));
  const plot = playerPlot();
  const choice = document.querySelector('#player select');
  expect('the player has all instances', choice.options.length === new Set(rows.filter(hasCurve).map(row => row.group)).size);
  for (const option of choice.options) {
    change(choice, option.value);
    await settled();
    const solvers = new Set(plot.drawn.data.filter(row => row.kind === 'curve').map(row => row.solver));
    const number = rows.filter(row => String(row.group) === option.value && hasCurve(row)).length;
    expect(`the player shows ${option.textContent}`, solvers.size === Math.min(number, kMostPanels));
  }
  change(choice, choice.options[0].value);
  await settled();
}
