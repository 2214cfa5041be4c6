// Somebody who knows the truth, and corrects a sequence with the page's own gestures and queue: what to draw next.

/** Of the cells that a lasso goes around, m. A person sees detections that lie this near together as one blob. */
const CELL = 0.25;

/** A lasso around wrong labels in sight: {corners, gain}, in metres of the vehicle frame; `null` where none is worth it. */
export function bestLasso(seen, from, least) {
  const net = new Map();
  for (const { x, y, label, truth } of seen) {
    if (label !== from) continue;
    const key = cellKey(Math.floor(x / CELL), Math.floor(y / CELL));
    net.set(key, (net.get(key) ?? 0) + (truth === from ? -1 : 1));
  }
  let best = null;
  for (const cells of [...components(net, false), ...components(net, true)]) {
    const corners = outline(cells).map(([i, j]) => [i * CELL, j * CELL]);
    const gain = gainOf(seen, corners, from);
    if (gain >= least && (best === null || gain > best.gain)) best = { corners, gain };
  }
  return best;
}

/** How many more labels are right once everything inside has the other label. */
function gainOf(seen, corners, from) {
  const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  let gain = 0;
  for (const { x, y, label, truth } of seen) {
    if (label !== from || x < left || x > right || y < low || y > high || !inside([x, y], corners)) continue;
    gain += truth === from ? -1 : 1;
  }
  return gain;
}

export function inside([x, y], corners) {
  let is = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) is = !is;
  });
  return is;
}

const cellKey = (i, j) => `${i},${j}`;
const cellOf = (key) => key.split(",").map(Number);
const SIDES = [
  [1, 0],
  [0, 1],
  [-1, 0],
  [0, -1],
];

/** Cells with more wrong than right labels that lie together; `wide`: with the empty ones around them. */
function components(net, wide) {
  const wrong = [...net].filter(([, sum]) => sum > 0).map(([key]) => key);
  const open = new Set(wrong);
  if (wide) {
    for (const [i, j] of wrong.map(cellOf)) {
      for (let di = -1; di <= 1; di += 1)
        for (let dj = -1; dj <= 1; dj += 1) {
          const key = cellKey(i + di, j + dj);
          if ((net.get(key) ?? 0) >= 0) open.add(key);
        }
    }
  }
  const found = [];
  while (open.size > 0) {
    const [first] = open;
    open.delete(first);
    const cells = [first];
    for (let at = 0; at < cells.length; at += 1) {
      const [i, j] = cellOf(cells[at]);
      for (const [di, dj] of SIDES) {
        const next = cellKey(i + di, j + dj);
        if (open.delete(next)) cells.push(next);
      }
    }
    if (cells.some((key) => (net.get(key) ?? 0) > 0)) found.push(new Set(cells));
  }
  return found;
}

/** The outer edge of cells that lie side by side, as corners in turn. */
function outline(cells) {
  const ends = new Map();
  for (const [i, j] of [...cells].map(cellOf)) {
    const corners = [
      [i, j],
      [i + 1, j],
      [i + 1, j + 1],
      [i, j + 1],
    ];
    const outside = [
      [i, j - 1],
      [i + 1, j],
      [i, j + 1],
      [i - 1, j],
    ];
    outside.forEach(([oi, oj], side) => {
      if (cells.has(cellKey(oi, oj))) return;
      const start = cellKey(...corners[side]);
      ends.set(start, [...(ends.get(start) ?? []), corners[(side + 1) % 4]]);
    });
  }
  // The lowest of the leftmost corners is on the outer edge.
  const first = [...ends.keys()].map(cellOf).sort((a, b) => a[0] - b[0] || a[1] - b[1])[0];
  const path = [first];
  let [at, before] = [first, [0, -1]];
  for (;;) {
    const choices = ends.get(cellKey(...at));
    const turn = ([i, j]) => before[0] * (j - at[1]) - before[1] * (i - at[0]);
    const next = choices.sort((a, b) => turn(b) - turn(a))[0];
    before = [next[0] - at[0], next[1] - at[1]];
    at = next;
    if (at[0] === first[0] && at[1] === first[1]) return straightened(path);
    path.push(at);
  }
}

/** Without corners that lie on a line. */
function straightened(path) {
  return path.filter(([x, y], i) => {
    const [px, py] = path[(i + path.length - 1) % path.length];
    const [nx, ny] = path[(i + 1) % path.length];
    return (x - px) * (ny - y) - (y - py) * (nx - x) !== 0;
  });
}
