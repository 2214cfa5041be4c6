import assert from "node:assert/strict";
import { test } from "node:test";
import { combine, countOf, intersection, inverted } from "../../src/selection/mask.js";
import { begun, moved, pressedAgain, shapeOf, TOOLS } from "../../src/selection/tools.js";

test("no tool encloses anything before the pointer has moved, but the brush", () => {
  for (const tool of TOOLS) {
    const shape = shapeOf(begun(tool, [5, 5]), 10);
    assert.equal(shape?.kind, tool === "brush" ? "stroke" : undefined, tool);
  }
});

test("a box spans from the press to the pointer", () => {
  const gesture = moved(moved(begun("box", [1, 2]), [5, 6]), [9, 4]);
  assert.deepEqual(shapeOf(gesture, 0), { kind: "box", from: [1, 2], to: [9, 4] });
});

test("a lasso leaves out steps too small to see", () => {
  const gesture = [
    [10, 0],
    [10.5, 0],
    [10, 10],
    [0, 10],
  ].reduce((line, [x, y]) => moved(line, [x, y]), begun("lasso", [0, 0]));
  assert.deepEqual(shapeOf(gesture, 0), {
    kind: "polygon",
    corners: [
      [0, 0],
      [10, 0],
      [10, 10],
      [0, 10],
    ],
  });
});

test("a polygon closes on its first corner, once it has three", () => {
  let gesture = begun("polygon", [0, 0]);
  assert.equal(pressedAgain(gesture, [2, 2]).closed, false);
  for (const corner of [
    [50, 0],
    [50, 50],
  ] as const)
    gesture = pressedAgain(gesture, corner).gesture;
  const closing = pressedAgain(gesture, [3, 3]);
  assert.equal(closing.closed, true);
  assert.deepEqual(shapeOf(closing.gesture, 0), {
    kind: "polygon",
    corners: [
      [0, 0],
      [50, 0],
      [50, 50],
    ],
  });
});

test("selections combine", () => {
  const [before, gesture] = [new Uint8Array([1, 1, 0, 0]), new Uint8Array([1, 0, 1, 0])];
  assert.deepEqual([...combine(before, gesture, "replace")], [1, 0, 1, 0]);
  assert.deepEqual([...combine(before, gesture, "add")], [1, 1, 1, 0]);
  assert.deepEqual([...combine(before, gesture, "remove")], [0, 1, 0, 0]);
  assert.deepEqual([...inverted(before, new Uint8Array([1, 0, 1, 0]))], [0, 0, 1, 0]);
  assert.deepEqual([...intersection(before, gesture)], [1, 0, 0, 0]);
  assert.equal(countOf(before), 2);
});
