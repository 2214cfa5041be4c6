import assert from "node:assert/strict";
import { test } from "node:test";
import type { DoubtfulThing } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { LabelBook } from "../../src/data/labels.js";
import { nextThing, Things, wholeThings } from "../../src/data/things.js";
import { movePlace } from "../../src/data/transform.js";
import { selectedText } from "../../src/panels/status-bar.js";
import { made } from "./scans.js";

const scans = [
  { radar: "front", scan: 0, rows: 3 },
  { radar: "front", scan: 1, rows: 2 },
];
const things = new Things({
  rows: 5,
  infos: [],
  header: { run: "", scans, doubtful: [], things: 3, expected_errors: 0 },
  columns: new Map([["thing", new Uint32Array([0, 1, 1, 1, 2])]]),
});

function doubtful(thing: number, x: number | null, errors: number): DoubtfulThing {
  const place = [x, x === null ? null : 0, 0] as const;
  const counts = { detections: 2, scans: 1, plausible: 1, answered: 0 };
  return { thing, place, radius: 1, ...counts, expected_errors: errors, radar: "front", scan: 0, point: 0 };
}

test("a thing is found in every scan, on screen or not", () => {
  assert.equal(things.of({ radar: "front", scan: 1 }, 0), 1);
  assert.equal(things.of({ radar: "rear", scan: 1 }, 0), -1);
  assert.deepEqual(things.members(1), [
    { radar: "front", scan: 0, points: [1, 2] },
    { radar: "front", scan: 1, points: [0] },
  ]);
});

test("who chooses a detection of a thing chooses what is shown of it", () => {
  const cloud = buildCloud([made("front", 1, { x: [1, 2] }), made("front", 0, { x: [3, 4, 5] })]);
  const whole = wholeThings(things, cloud, new Uint8Array([1, 0, 0, 0, 0]), new Uint8Array([1, 1, 1, 1, 0]));
  assert.deepEqual([...whole], [1, 0, 0, 1, 0]);
});

test("the next thing is where the most errors are expected together, away from what was seen", () => {
  const all = [doubtful(0, 0, 5), doubtful(1, 50, 4), doubtful(2, 52, 3), doubtful(3, null, 9)];
  assert.equal(nextThing(all, [])?.thing, 1);
  assert.equal(nextThing(all, [[51, 0]])?.thing, 0);
  assert.equal(
    nextThing(all, [
      [51, 0],
      [1, 0],
    ]),
    null,
  );
});

test("a place of the world is found again from the vehicle", () => {
  const turned = [0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 0, 0, 0, 0, 1];
  assert.deepEqual(movePlace(turned, [10, 23, 1]), [3, 0, 1]);
  assert.deepEqual(movePlace(null, [1, 2, 3]), [1, 2, 3]);
});

test("a selection over scans says how many of it say otherwise", () => {
  const labels = new LabelBook([
    { id: 1, name: "outlier", cluster: "artifact", plausible: false },
    { id: 99, name: "plausible", cluster: null, plausible: true },
  ]);
  const cloud = buildCloud([made("front", 1, { x: [1, 2] }), made("front", 0, { x: [3, 4], machine: [99, 1] })]);
  const text = (mask: readonly number[]): string => selectedText(new Uint8Array(mask), cloud, labels);
  assert.equal(text([1, 1, 0, 0]), "2 detections selected");
  assert.equal(text([1, 1, 1, 1]), "4 detections selected in 2 scans, most plausible, 1 say otherwise");
});
