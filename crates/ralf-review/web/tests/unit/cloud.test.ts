import assert from "node:assert/strict";
import { test } from "node:test";
import { buildCloud, columnOf, gather, maskOf, pointOf, pointsByScan, withScans } from "../../src/data/cloud.js";
import { certaintyOf, everything, hides, isUncertain, type Origin, visible } from "../../src/data/filter.js";
import { LabelBook } from "../../src/data/labels.js";
import { withCorrections } from "../../src/data/scan.js";
import { Sight } from "../../src/data/sight.js";
import { compose, IDENTITY, inverse } from "../../src/data/transform.js";
import { sayer } from "../../src/panels/details-panel.js";
import { made } from "./scans.js";

/** The vehicle turned to the left by `angle` at x, y. */
function pose(x: number, y: number, angle: number): number[] {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0, 0, 0, 0, 1];
}

const labels = new LabelBook([
  { id: 1, name: "outlier", cluster: "artifact", plausible: false },
  { id: 10, name: "car", cluster: "vehicle", plausible: true },
]);
const close = (a: ArrayLike<number>, b: readonly number[]): void =>
  b.forEach((value, i) => assert.ok(Math.abs(a[i] - value) < 1e-5, `${a[i]} is not ${value}`));

test("a motion and its inverse leave everything where it is", () => {
  const m = pose(3, -2, 0.7);
  close(compose(m, inverse(m)), [...IDENTITY]);
});

test("detections of an earlier scan are moved to the vehicle's place at the one under review", () => {
  const now = made("front", 1, { x: [5], odom: pose(10, 0, Math.PI / 2) });
  const before = made("front", 0, { x: [12], odom: pose(0, 0, 0) });
  const cloud = buildCloud([now, before]);
  close(cloud.positions, [5, 0, 0]);
  // 2 m ahead of where the vehicle is now, which is to its right since it turned left.
  close(cloud.positions.subarray(3), [0, -2, 0]);
  assert.ok(cloud.compensated);
});

test("without odometry scans stay where they were measured, and the cloud says so", () => {
  const cloud = buildCloud([made("front", 1, { x: [5], time: "100000000" }), made("front", 0, { x: [12] })]);
  close(cloud.positions, [5, 0, 0, 12, 0, 0]);
  assert.ok(!cloud.compensated);
});

test("detections keep the names under which the server knows them", () => {
  const cloud = buildCloud([made("front", 4, { x: [1, 2, 3] }), made("rear", 9, { x: [7, 8], w: [0.1, 0.2] })]);
  assert.deepEqual([cloud.count, pointOf(cloud, 4).scan.radar, pointOf(cloud, 4).point], [5, "rear", 1]);
  const named = pointsByScan(cloud, new Uint8Array([0, 1, 0, 0, 1]));
  assert.deepEqual(named, [
    { radar: "front", scan: 4, points: [1] },
    { radar: "rear", scan: 9, points: [1] },
  ]);
  assert.deepEqual([...maskOf(cloud, named)], [0, 1, 0, 0, 1]);
  close([columnOf(cloud, 4, "w")], [0.2]);
  assert.ok(Number.isNaN(gather(cloud, "rcs")[0]));
});

test("a correction sets its detection alone, and its end gives the machine's label back", () => {
  const scan = made("front", 0, { x: [1, 2], machine: [99, 99] });
  const after = withCorrections(scan, {
    radar: "front",
    scan: 0,
    revision: 1,
    causes: [],
    corrections: [[1, 10]],
    reviewed: null,
  });
  assert.ok(after !== null);
  assert.deepEqual([[...after.label], [...after.corrected], after.revision], [[99, 10], [0, 1], 1]);
  const back = withCorrections(after, {
    radar: "front",
    scan: 0,
    revision: 2,
    causes: [],
    corrections: [],
    reviewed: null,
  });
  assert.deepEqual(
    [[...(back?.label ?? [])], [...(back?.corrected ?? [])]],
    [
      [99, 99],
      [0, 0],
    ],
  );
  const cloud = withScans(buildCloud([scan]), [after]);
  assert.deepEqual([...cloud.label], [99, 10]);
});

test("labels of other detections than are on screen are never put onto those", () => {
  const cloud = buildCloud([made("front", 0, { x: [1, 2], content: "then" })]);
  const others = [
    { x: [1, 2], content: "now" },
    { x: [1, 2, 3], content: "then" },
    { x: [2, 1], content: "then" },
  ];
  for (const other of others) assert.throws(() => withScans(cloud, [made("front", 0, other)]), /found others/);
  assert.ok(withScans(cloud, [made("front", 0, { x: [1, 2], content: "then", machine: [1, 1] })]).label[0] === 1);
});

test("what a scan was accepted with is the server's to say", () => {
  const scan = made("front", 0, { x: [1], corrected: [1], reviewed: true });
  const now = { radar: "front", scan: 0, revision: 2, causes: [], corrections: [] };
  assert.equal(withCorrections(scan, { ...now, reviewed: scan.reviewed }), null);
  // A mark that was taken away, by undo or by somebody else.
  assert.equal(withCorrections(scan, { ...now, causes: [], corrections: [[0, 99]], reviewed: null }), null);
});

test("every filter lets through what it says", () => {
  const cloud = buildCloud([
    made("front", 0, { x: [1, 20, 60], w: [0.95, 0.55, Number.NaN], machine: [99, 1, 99], corrected: [1, 0, 0] }),
  ]);
  const shown = (filter: Partial<typeof everything>): number[] => [
    ...visible(cloud, { ...everything, ...filter }, labels, { threshold: 0.5, decided: 1 }),
  ];
  assert.deepEqual(shown({}), [1, 1, 1]);
  assert.deepEqual(shown({ artifact: false }), [1, 0, 1]);
  assert.deepEqual(shown({ origin: "corrected" }), [1, 0, 0]);
  assert.deepEqual(shown({ origin: "machine" }), [0, 1, 1]);
  assert.deepEqual(shown({ uncertain: true }), [0, 1, 0]);
  assert.deepEqual(shown({ score: [0.5, 1] }), [1, 1, 0]);
  assert.deepEqual(shown({ range: [0, 30] }), [1, 1, 0]);
  assert.deepEqual(shown({ height: [1, 2] }), [0, 0, 0]);
  assert.deepEqual(shown({ flags: 4 }), [0, 0, 0]);
  assert.deepEqual(shown({ hiddenRadars: new Set(["front"]) }), [0, 0, 0]);
  assert.ok(
    !hides(everything) &&
      hides({ ...everything, range: [0, 30] }) &&
      hides({ ...everything, hiddenRadars: new Set(["front"]) }),
  );
});

test("a label that was accepted isn't the machine's once that says otherwise", () => {
  const scan = made("front", 0, { x: [1, 2, 3], corrected: [0, 0, 1], reviewed: true });
  const cloud = buildCloud([{ ...scan, label: new Uint16Array([1, 99, 99]) }]);
  const by = (origin: Origin): number[] => [
    ...visible(cloud, { ...everything, origin }, labels, { threshold: 0.5, decided: 1 }),
  ];
  assert.deepEqual(
    [by("any"), by("machine"), by("corrected")],
    [
      [1, 1, 1],
      [0, 1, 0],
      [0, 0, 1],
    ],
  );
  assert.deepEqual(
    [0, 1, 2].map((i) => sayer(cloud, i)),
    ["accepted by ada", "by machine", "corrected"],
  );
});

test("a floor detection is decided, however near its score is to the threshold", () => {
  const certainty = certaintyOf({
    threshold: 0.5,
    flags: [
      { bit: 1, name: "ground", decided: true },
      { bit: 2, name: "blind spot", decided: false },
    ],
  });
  assert.deepEqual(
    [0, 1, 2, 3].map((flags) => isUncertain(0.45, flags, certainty)),
    [true, false, true, false],
  );
  assert.ok(!isUncertain(0.7, 0, certainty));
});

test("where a model answers, a floor detection is decided only if the paper's method stood in for it", () => {
  const flags = [1, 64].map((bit) => ({ bit, name: `${bit}`, decided: true }));
  const certainty = certaintyOf({ threshold: 0.5, flags });
  assert.deepEqual(
    [0, 1, 64, 65].map((bits) => isUncertain(0.45, bits, certainty)),
    [true, true, true, false],
  );
});

test("what was never on screen is counted until it was, and another scan begins unseen", () => {
  const cloud = buildCloud([made("front", 0, { x: [1, 2, 3, Number.NaN] }), made("rear", 0, { x: [9] })]);
  const sight = new Sight();
  const [all, places] = [new Uint8Array([1, 1, 1, 1, 1]), (seen: readonly number[]) => new Float32Array(seen)];
  assert.deepEqual(sight.unseen(cloud, all), { all: 3, hidden: 0 });
  sight.saw(cloud, new Uint8Array([1, 0, 1, 1, 1]), places([5, 5, 6, 6, NaN, NaN, NaN, NaN, 1, 1]));
  assert.deepEqual(sight.unseen(cloud, new Uint8Array([1, 0, 1, 1, 1])), { all: 2, hidden: 1 });
  sight.saw(cloud, all, places([NaN, NaN, 6, 6, 7, 7, NaN, NaN, 1, 1]));
  assert.deepEqual(sight.unseen(cloud, all), { all: 0, hidden: 0 });
  const next = buildCloud([made("front", 1, { x: [1, 2] })]);
  assert.equal(sight.unseen(next, new Uint8Array([1, 1])).all, 2);
  const away = { ...next, positions: next.positions.map(() => NaN), held: true };
  assert.equal(
    sight.unseen(away, new Uint8Array([1, 1])).all,
    2,
    "held still, the scan is away and nobody has seen it",
  );
});
