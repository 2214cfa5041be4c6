import assert from "node:assert/strict";
import { test } from "node:test";
import { fitted, movedBy, toScreen, zoomedAt } from "../../src/cameras/frame.js";
import { ARTIFACT_RGB, diverging, PLAUSIBLE_RGB, type Rgb, viridis } from "../../src/viewer/palette.js";
import { projectAll } from "../../src/viewer/project.js";
import { around, eye, HOME, panned, turned, zoomed } from "../../src/viewer/rig.js";
import { roundLength } from "../../src/viewer/scale.js";

/** CIE luminance, roughly. */
const luminance = ([r, g, b]: Rgb): number =>
  0.2126 * (r / 255) ** 2.2 + 0.7152 * (g / 255) ** 2.2 + 0.0722 * (b / 255) ** 2.2;
/** Contrast as WCAG has it. */
const contrast = (a: Rgb, b: Rgb): number => {
  const [dark, bright] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (bright + 0.05) / (dark + 0.05);
};

test("places in clip space become pixels from the upper left; what is behind or beside is left out", () => {
  // Columns: x to the right, y up, w = z.
  const m = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0];
  const pixels = projectAll(m, new Float32Array([0, 0, 2, 1, 1, 2, -2, 0, 2, 3, 0, 2, 0, 0, -1]), 200, 100);
  assert.deepEqual([...pixels], [100, 50, 150, 25, 0, 50, NaN, NaN, NaN, NaN]);
});

test("zooming keeps the place under the pointer where it is", () => {
  const rig = zoomed({ ...HOME, target: [10, 0, 0] }, 0.5, [30, 8]);
  assert.equal(rig.span, HOME.span / 2);
  assert.deepEqual(rig.target, [20, 4, 0]);
});

test("zooming ends somewhere", () => {
  assert.ok(zoomed(HOME, 1e-9, null).span > 1 && zoomed(HOME, 1e9, null).span < 1e4);
});

test("from above, the ground follows the pointer", () => {
  // 100 m over 500 px: dragging 50 px to the right and 25 px down looks 10 m to the left and 5 m ahead.
  assert.deepEqual(panned(HOME, 50, 25, 500, true).target, [5, 10, 0]);
});

test("the free eye is behind the vehicle and above the ground, however one turns", () => {
  const [x, y, z] = eye(HOME);
  assert.ok(x < -20 && Math.abs(y) < 1e-9 && z > 20);
  for (const down of [-1e4, 1e4]) assert.ok(eye(turned(HOME, 123, down))[2] > 0);
});

test("the whole scan is in the picture, however far it reaches", () => {
  assert.equal(around(new Float32Array([10, 20, 0, -30, 5, 1]), [800, 600]).span, HOME.span);
  const far = around(new Float32Array([120, 0, 0, Number.NaN, 9, 9, 0, -200, 0]), [1000, 500]);
  assert.ok(far.span / 2 >= 120 && far.span >= 200, `${far.span}`);
});

test("an image is fitted whole, in the middle, and zoomed at the pointer", () => {
  const frame = fitted([400, 200], [800, 800]);
  assert.deepEqual(frame, { scale: 2, left: 0, top: 200 });
  const places = new Float32Array([-0.5, -0.5, 399.5, 199.5, Number.NaN, Number.NaN]);
  assert.deepEqual([...toScreen(frame, places)], [0, 200, 800, 600, Number.NaN, Number.NaN]);
  const near = zoomedAt(frame, 3, [100, 300]);
  assert.deepEqual(toScreen(near, new Float32Array([49.5, 49.5])), toScreen(frame, new Float32Array([49.5, 49.5])));
  assert.deepEqual(movedBy(frame, 3, -4), { scale: 2, left: 3, top: 196 });
});

test("maps of colour end where their stops end, and stay there", () => {
  assert.deepEqual(viridis(1), [253, 231, 37]);
  assert.deepEqual(viridis(7), viridis(1));
  assert.deepEqual(diverging(-1), diverging(0));
  for (let share = 0; share < 1; share += 0.05) assert.ok(luminance(viridis(share)) < luminance(viridis(share + 0.05)));
});

test("labels stand out from the ground and from each other", () => {
  const ground: Rgb = [11, 14, 19];
  assert.ok(contrast(PLAUSIBLE_RGB, ground) > 6 && contrast(ARTIFACT_RGB, ground) > 6);
});

test("the scale bar has a round length", () => {
  assert.deepEqual([0.7, 1, 9.9, 23, 60, 199].map(roundLength), [0.5, 1, 5, 20, 50, 100]);
});
