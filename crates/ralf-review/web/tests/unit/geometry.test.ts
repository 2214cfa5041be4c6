import assert from "node:assert/strict";
import { test } from "node:test";
import {
  collect,
  contains,
  distanceToSegment,
  insidePolygon,
  nearest,
  type Point,
} from "../../src/selection/geometry.js";

const SQUARE: readonly Point[] = [
  [0, 0],
  [10, 0],
  [10, 10],
  [0, 10],
];

test("a polygon holds what it encloses, whichever way round it was drawn", () => {
  for (const corners of [SQUARE, [...SQUARE].reverse()]) {
    assert.ok(insidePolygon(corners, [5, 5]));
    assert.ok(!insidePolygon(corners, [11, 5]));
    assert.ok(!insidePolygon(corners, [5, -0.1]));
  }
});

test("a concave polygon leaves its notch out", () => {
  const notched: readonly Point[] = [
    [0, 0],
    [10, 0],
    [10, 10],
    [5, 3],
    [0, 10],
  ];
  assert.ok(!insidePolygon(notched, [5, 8]));
  assert.ok(insidePolygon(notched, [1, 5]));
  assert.ok(insidePolygon(notched, [5, 2]));
});

test("the loop of a line that crosses itself lies outside where it was gone round twice", () => {
  const bow: readonly Point[] = [
    [0, 0],
    [10, 10],
    [10, 0],
    [0, 10],
  ];
  assert.ok(insidePolygon(bow, [1, 5]));
  assert.ok(insidePolygon(bow, [9, 5]));
  assert.ok(!insidePolygon(bow, [5, 1]));
});

test("every place is in exactly one of the two halves that share an edge", () => {
  const left: readonly Point[] = [
    [0, 0],
    [5, 0],
    [5, 10],
    [0, 10],
  ];
  const right: readonly Point[] = [
    [5, 0],
    [10, 0],
    [10, 10],
    [5, 10],
  ];
  for (let x = 0.25; x < 10; x += 0.25) {
    for (let y = 0.25; y < 10; y += 0.25) {
      assert.equal(Number(insidePolygon(left, [x, y])) + Number(insidePolygon(right, [x, y])), 1, `${x} ${y}`);
    }
  }
});

test("distances are to the stretch, not to the line", () => {
  assert.equal(distanceToSegment([5, 3], [0, 0], [10, 0]), 3);
  assert.equal(distanceToSegment([13, 4], [0, 0], [10, 0]), 5);
  assert.equal(distanceToSegment([3, 4], [0, 0], [0, 0]), 5);
});

test("boxes and brushes count their border", () => {
  assert.ok(contains({ kind: "box", from: [10, 10], to: [0, 0] }, [0, 10]));
  assert.ok(contains({ kind: "stroke", path: [[0, 0]], radius: 5 }, [3, 4]));
  assert.ok(!contains({ kind: "stroke", path: [[0, 0]], radius: 5 }, [3, 4.1]));
  assert.ok(
    contains(
      {
        kind: "stroke",
        path: [
          [0, 0],
          [10, 0],
          [10, 10],
        ],
        radius: 1,
      },
      [10.9, 6],
    ),
  );
});

test("collecting skips what isn't eligible or not in the picture", () => {
  const places = new Float32Array([5, 5, 6, 6, Number.NaN, Number.NaN, 50, 50]);
  const mask = new Uint8Array(4);
  collect({ kind: "polygon", corners: SQUARE }, places, new Uint8Array([1, 0, 1, 1]), mask);
  assert.deepEqual([...mask], [1, 0, 0, 0]);
});

test("the nearest eligible place within reach is found", () => {
  const places = new Float32Array([0, 0, 3, 0, 4, 0, Number.NaN, Number.NaN]);
  assert.equal(nearest(places, new Uint8Array([1, 1, 1, 1]), [3.4, 0], 5), 1);
  assert.equal(nearest(places, new Uint8Array([1, 0, 1, 1]), [3.4, 0], 5), 2);
  assert.equal(nearest(places, new Uint8Array([1, 1, 1, 1]), [30, 0], 5), -1);
});
