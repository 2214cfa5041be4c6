import assert from "node:assert/strict";
import { test } from "node:test";
import type { Pending } from "../../src/history/outbox.js";
import { inPieces } from "../../src/history/pieces.js";

/** A stroke on so many scans, of so many detections each, as long as real ones are. */
function stroke(scans: number, detections: number): Pending {
  const content = "0123456789abcdef".repeat(4);
  const numbers = Array.from({ length: scans }, (_, scan) => scan);
  const points = Array.from({ length: detections }, (_, point) => 100_000 + point);
  return {
    sequence: "00",
    stroke: {
      id: "rule on all",
      tool: "rule",
      protect: true,
      label: 99,
      cause: "road",
      base: numbers.map((scan) => ({ radar: "radar_front_left", scan, revision: 12, content })),
      points: numbers.map((scan) => ({ radar: "radar_front_left", scan, points })),
    },
  };
}

test("a stroke that one request can hold stays as it is", () => {
  const small = stroke(3, 2);
  assert.deepEqual(inPieces(small), [small]);
  assert.deepEqual(inPieces(stroke(0, 0)), [stroke(0, 0)]);
});

test("a stroke over a long sequence is made in pieces that a server takes, as one step", () => {
  const whole = stroke(30_000, 60);
  assert.ok(JSON.stringify(whole.stroke).length > 8 * 2 ** 20);
  const pieces = inPieces(whole);
  assert.ok(pieces.length > 1);
  for (const { sequence, stroke } of pieces) {
    assert.ok(JSON.stringify(stroke).length < 8 * 2 ** 20);
    assert.equal(sequence, "00");
    assert.deepEqual([stroke.tool, stroke.label, stroke.cause], ["rule", 99, "road"]);
    assert.deepEqual(
      stroke.base.map(({ scan }) => scan),
      stroke.points.map(({ scan }) => scan),
    );
  }
  assert.deepEqual(
    pieces.flatMap(({ stroke }) => stroke.points),
    whole.stroke.points,
  );
  const groups = new Set(pieces.map(({ stroke }) => stroke.group));
  assert.ok(groups.size === 1 && !groups.has(undefined));
  assert.equal(new Set(pieces.map(({ stroke }) => stroke.id)).size, pieces.length);
});

test("pieces of a stroke that is one of several stay in its group", () => {
  const one = stroke(4, 2);
  const pieces = inPieces({ ...one, stroke: { ...one.stroke, group: "both" } }, 600);
  assert.deepEqual(
    pieces.map(({ stroke }) => stroke.group),
    ["both", "both", "both", "both"],
  );
});
