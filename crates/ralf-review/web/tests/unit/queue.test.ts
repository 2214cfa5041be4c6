import assert from "node:assert/strict";
import { test } from "node:test";
import type { QueueScan } from "../../src/api/types.js";
import {
  listed,
  neighbour,
  nextNeedy,
  progressOf,
  reasons,
  withAnswers,
  withPlaceKept,
  withReviewed,
} from "../../src/queue/queue.js";

const ADA = { author: "ada", at: "2024-01-01T00:00:00Z" };

function entry(radar: string, scan: number, patch: Partial<QueueScan> = {}): QueueScan {
  const whole = {
    detections: 10,
    expected_errors: 4.5,
    uncertain: 0,
    disagreeing: 0,
    cameras_failed: 0,
    corrected: 0,
    reviewed: null,
    orphaned: 0,
  };
  return { radar, scan, t_ns: `${1_600_000_000_000_000_000n + BigInt(scan) * 50_000_000n}`, ...whole, ...patch };
}

/** Most needy first, as the server sends them. */
const SCANS = [entry("front", 7), entry("rear", 2), entry("front", 1, { reviewed: ADA }), entry("front", 8)];

test("the next needy scan is the next of the order that nobody reviewed, and the list goes round", () => {
  assert.equal(nextNeedy(SCANS, null), SCANS[0]);
  assert.equal(nextNeedy(SCANS, { radar: "rear", scan: 2 }), SCANS[3]);
  assert.equal(nextNeedy(SCANS, { radar: "front", scan: 8 }), SCANS[0]);
  assert.equal(
    nextNeedy(
      SCANS.map((scan) => ({ ...scan, reviewed: ADA })),
      null,
    ),
    null,
  );
});

test("the only open scan isn't its own successor", () => {
  assert.equal(nextNeedy([SCANS[0], SCANS[2]], SCANS[0]), null);
});

test("time order looks at nanoseconds, beyond what a number holds", () => {
  const near = [entry("b", 0, { t_ns: "1600000000000000002" }), entry("a", 0, { t_ns: "1600000000000000001" })];
  const order = listed(near, { order: "time", hideReviewed: false, radar: null });
  assert.deepEqual(
    order.map(({ radar }) => radar),
    ["a", "b"],
  );
});

test("the list may be one radar's, without what is done", () => {
  const order = listed(SCANS, { order: "need", hideReviewed: true, radar: "front" });
  assert.deepEqual(
    order.map(({ scan }) => scan),
    [7, 8],
  );
});

test("neighbours are of the same radar", () => {
  assert.equal(neighbour(SCANS, { radar: "front", scan: 7 }, 1)?.scan, 8);
  assert.equal(neighbour(SCANS, { radar: "front", scan: 7 }, -1)?.scan, 1);
  assert.equal(neighbour(SCANS, { radar: "front", scan: 8 }, 1), null);
});

test("reasons name what speaks for a person", () => {
  assert.deepEqual(reasons(entry("front", 0, { cameras_failed: 1, uncertain: 31 })), ["camera failed", "31 uncertain"]);
  assert.deepEqual(reasons(entry("front", 0, { cameras_failed: 2, disagreeing: 4 })), [
    "2 cameras failed",
    "4 disagree",
  ]);
});

test("progress follows what is done", () => {
  const marked = withReviewed(SCANS, { radar: "rear", scan: 2 }, ADA);
  const counted = withAnswers(marked, [
    {
      radar: "front",
      scan: 7,
      revision: 1,
      reviewed: ADA,
      causes: [],
      corrections: [
        [0, 1],
        [4, 99],
      ],
    },
  ]);
  const before = { scans: 0, reviewed: 0, corrected_detections: 0, orphaned_scans: 3 };
  assert.deepEqual(progressOf(counted, before), {
    scans: 4,
    reviewed: 3,
    corrected_detections: 2,
    orphaned_scans: 3,
  });
  const undone = withAnswers(marked, [
    { radar: "rear", scan: 2, revision: 0, reviewed: null, causes: [], corrections: [] },
  ]);
  assert.equal(progressOf(undone, before).reviewed, 1, "undo takes a mark back");
});

test("the scan that is looked at keeps its place, whatever is said of it, and the rest is in order", () => {
  const needs = (scan: number, errors: number): QueueScan => entry("front", scan, { expected_errors: errors });
  const before = [needs(1, 80), needs(2, 60), needs(3, 40)];
  const numbers = (scans: readonly QueueScan[]): readonly number[] => scans.map(({ scan }) => scan);
  const mended = [needs(3, 40), needs(2, 30), needs(1, 2)];
  assert.deepEqual(numbers(withPlaceKept(mended, before[0])), [1, 3, 2]);
  assert.deepEqual(numbers(withPlaceKept(mended, before[1])), [2, 3, 1]);
  assert.deepEqual(numbers(withPlaceKept(mended, null)), [3, 2, 1]);
  assert.deepEqual(numbers(withPlaceKept(mended, needs(9, 99))), [3, 2, 1]);
  const reviewed = [...mended.slice(0, 2), entry("front", 1, { expected_errors: 0, reviewed: ADA })];
  assert.deepEqual(numbers(withPlaceKept(reviewed, before[0])), [1, 3, 2]);
  assert.equal(nextNeedy(withPlaceKept(reviewed, before[0]), before[0])?.scan, 3);
});
