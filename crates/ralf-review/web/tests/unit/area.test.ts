import assert from "node:assert/strict";
import { test } from "node:test";
import { type Area, areaOf, areasFrom, cornersHere, crosses, inAreas, mirrored } from "../../src/data/area.js";
import { buildCloud } from "../../src/data/cloud.js";
import { heldStill } from "../../src/data/held.js";
import { LabelBook } from "../../src/data/labels.js";
import { made } from "./scans.js";

const labels = new LabelBook([]);
/** The vehicle at (100, 50), turned to the left by a right angle: what is ahead of it lies in +y. */
const turned = [0, -1, 0, 100, 1, 0, 0, 50, 0, 0, 1, 0, 0, 0, 0, 1];

const home = { dataset: "city", sequence: "00" };

function area(kind: Area["kind"], corners: Area["corners"]): Area {
  return { kind, ...home, corners };
}

test("an outline is kept in the world and comes back where it was drawn", () => {
  const cloud = buildCloud([made("front", 0, { x: [2, 9], odom: turned })]);
  const drawn = [
    [1, -1],
    [3, -1],
    [3, 1],
    [1, 1],
  ] as const;
  const found = areaOf("inside", drawn, cloud, home);
  assert.ok(found !== null);
  assert.deepEqual(found.corners[0], [101, 51]);
  assert.deepEqual(
    cornersHere(found, cloud).map(([x, y]) => [Math.round(x), Math.round(y)]),
    drawn,
  );
  assert.deepEqual([...inAreas(cloud, [found], home, labels)], [1, 0]);
  for (const other of [{ sequence: "01" }, { dataset: "country" }])
    assert.deepEqual([...inAreas(cloud, [found], { ...home, ...other }, labels)], [0, 0], "elsewhere are other places");
});

test("places are the world's while something is held still", () => {
  const cloud = buildCloud([made("front", 0, { x: [2, 4] }), made("front", 1, { x: [3, 4], time: "100000000" })]);
  const outline = area("inside", [
    [3.5, -1],
    [4.5, -1],
    [4.5, 1],
    [3.5, 1],
  ]);
  const held = heldStill(cloud, new Uint8Array([1, 0, 1, 0]));
  assert.notDeepEqual(held.positions, held.measured);
  assert.deepEqual([...inAreas(held, [outline], home, labels)], [0, 1, 0, 1]);
});

test("what has no extent is no area", () => {
  const cloud = buildCloud([made("front", 0, { x: [1] })]);
  assert.equal(areaOf("inside", [[1, 1]], cloud, home), null);
  assert.equal(
    areaOf(
      "behind",
      [
        [1, 1],
        [1.01, 1],
      ],
      cloud,
      home,
    ),
    null,
  );
});

test("behind a surface lies what the radar sees through it, from where it was", () => {
  const wall = area("behind", [
    [5, -2],
    [5, 2],
  ]);
  const cloud = buildCloud([made("front", 0, { x: [3, 7] })]);
  assert.deepEqual([...inAreas(cloud, [wall], home, labels)], [0, 1]);
  const beyond = [1, 0, 0, 6, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const passed = buildCloud([
    made("front", 0, { x: [3, 7], odom: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }),
    made("front", 1, { x: [1], odom: beyond }),
  ]);
  assert.deepEqual([...inAreas(passed, [wall], home, labels)], [0, 1, 0], "the vehicle is past it by then");
});

test("a surface mirrors what is plausible before it, and nothing else behind it counts", () => {
  const wall = area("mirror", [
    [5, -2],
    [5, 2],
  ]);
  // 7 is the image of 3, 12 of -2, where nothing is; 9 of 1, which is an artifact.
  const cloud = buildCloud([made("front", 0, { x: [3, 7, 12, 1, 9], machine: [99, 1, 1, 1, 1] })]);
  const book = new LabelBook([{ id: 1, name: "outlier", cluster: null, plausible: false }]);
  assert.deepEqual([...inAreas(cloud, [wall], home, book)], [0, 1, 0, 0, 0]);
});

test("lines cross only between their ends, and mirror images are as far behind as the place is before", () => {
  assert.ok(crosses([0, 0], [2, 0], [1, -1], [1, 1]));
  assert.ok(!crosses([0, 0], [2, 0], [1, 1], [1, 3]));
  assert.ok(!crosses([0, 0], [0.5, 0], [1, -1], [1, 1]));
  assert.deepEqual(mirrored([3, 1], [0, 0], [5, 5]), [1, 3]);
});

test("areas that were kept are taken back as far as they make sense", () => {
  const whole = area("inside", [
    [0, 0],
    [1, 0],
    [0, 1],
  ]);
  const odd = [null, { kind: "inside", sequence: "00", corners: [[0, 0]] }, { ...whole, kind: "round" }];
  assert.deepEqual(areasFrom(JSON.parse(JSON.stringify([whole, ...odd]))), [whole]);
  assert.deepEqual(areasFrom("areas"), []);
});
