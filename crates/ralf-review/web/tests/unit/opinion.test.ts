import assert from "node:assert/strict";
import { test } from "node:test";
import type { Opinion, ProposedChange, ScanPoints } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { baseOf, countElsewhere, countOfPoints, kept, pointsOf } from "../../src/data/opinion.js";
import { made } from "./scans.js";

function change(thing: number, label: number, points: readonly ScanPoints[]): ProposedChange {
  const counts = { detections: 9, scans: 2, plausible: 9, answered: 0, expected_errors: 1 };
  const where = { place: [0, 0, 0], radius: 1, radar: "front", scan: 0, point: 0 } as const;
  return { thing, label, probability: 0.9, points, ...counts, ...where };
}

const front = (scan: number, ...points: number[]): ScanPoints => ({ radar: "front", scan, points });
const opinion: Opinion = {
  answered: 4,
  scans: { looked_at: 20, all: 20 },
  changes: [change(1, 1, [front(0, 0, 2), front(7, 5)]), change(2, 99, [front(0, 1)])],
  base: [
    { radar: "front", scan: 0, revision: 3 },
    { radar: "front", scan: 7, revision: 4 },
  ],
};
const cloud = buildCloud([made("front", 1, { x: [1, 2] }), made("front", 0, { x: [3, 4, 5] })]);

test("what is left out on screen isn't changed, and what isn't on screen is", () => {
  const all = kept(opinion, cloud, new Uint8Array([0, 0, 1, 1, 1]));
  assert.deepEqual(all, opinion);
  const some = kept(opinion, cloud, new Uint8Array([1, 1, 1, 0, 0]));
  assert.deepEqual(
    some.changes.map(({ thing, points }) => [thing, points]),
    [[1, [front(0, 0), front(7, 5)]]],
  );
});

test("changes of several things in a scan are one part of the stroke, on the revision that was learned from", () => {
  const points = pointsOf(opinion.changes);
  assert.deepEqual(points, [front(0, 0, 2, 1), front(7, 5)]);
  assert.equal(countOfPoints(points), 4);
  assert.equal(countElsewhere(opinion, cloud), 1);
  assert.deepEqual(
    baseOf(opinion, [front(7, 5), front(0, 1)]).map(({ scan, revision }) => [scan, revision]),
    [
      [0, 3],
      [7, 4],
    ],
  );
  assert.deepEqual(
    baseOf(opinion, [front(7, 5)]).map(({ scan }) => scan),
    [7],
  );
});
