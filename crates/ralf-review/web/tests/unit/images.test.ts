import assert from "node:assert/strict";
import { test } from "node:test";
import type { Column, Table } from "../../src/api/table.js";
import type { ThingInImageHeader } from "../../src/api/types.js";
import { around, regionOf, toScreen } from "../../src/cameras/frame.js";
import { setPoints, shareOf } from "../../src/cameras/lidar-layer.js";
import { placeThing, withoutPlaces } from "../../src/data/camera-moment.js";
import { buildCloud } from "../../src/data/cloud.js";
import { made } from "./scans.js";

const lidar = (points: readonly (readonly [u: number, v: number, depth: number, z: number])[]) => {
  const [u, v, depth, z] = [0, 1, 2, 3].map((at) => new Float32Array(points.map((point) => point[at])));
  return { count: points.length, u, v, depth, z };
};

test("a point of a LiDAR is a square around its pixel, and the nearest one is on top", () => {
  // 4 x 3 pixels of the image on 8 x 6 of the screen.
  const pixels = new Uint32Array(8 * 6);
  const frame = { scale: 2, left: 0, top: 0 };
  const points = lidar([
    [1, 1, 80, 0],
    [1, 1, 2, 0],
    [3, 2, 9, 0],
    [40, 1, 9, 0],
  ]);
  setPoints(pixels, 8, points, frame, 2, "depth");
  const set = [...pixels.keys()].filter((at) => pixels[at] !== 0).map((at) => [at % 8, Math.floor(at / 8)]);
  const squares = [
    [2, 2],
    [3, 2],
    [2, 3],
    [3, 3],
    [6, 4],
    [7, 4],
    [6, 5],
    [7, 5],
  ];
  assert.deepEqual(set, squares);
  // Viridis' bright end, 253 231 37, for what is 2 m away.
  assert.equal(pixels[2 * 8 + 2], ((255 << 24) | (37 << 16) | (231 << 8) | 253) >>> 0);
});

test("a point at the edge is cut off there, and never on the other side", () => {
  const pixels = new Uint32Array(4 * 4);
  setPoints(pixels, 4, lidar([[3.5, 0, 5, 0]]), { scale: 1, left: 0, top: 0 }, 3, "height");
  assert.deepEqual(
    [...pixels.keys()].filter((at) => pixels[at] !== 0),
    [3, 7],
  );
});

test("of too many points only some are drawn", () => {
  const pixels = new Uint32Array(8);
  const points = lidar([0, 1, 2, 3, 4, 5, 6, 7].map((u) => [u, 0, 9, 0] as const));
  setPoints(pixels, 8, points, { scale: 1, left: 0, top: 0 }, 1, "depth", 3);
  assert.deepEqual(
    [...pixels.keys()].filter((at) => pixels[at] !== 0),
    [0, 3, 6],
  );
});

test("what is near is bright by depth, what is high by height", () => {
  const points = lidar([
    [0, 0, 1, 9],
    [0, 0, Math.sqrt(160), 2],
    [0, 0, 200, -3],
  ]);
  const shares = (by: "depth" | "height"): readonly number[] => [0, 1, 2].map((i) => shareOf(points, i, by));
  assert.equal(shares("depth")[0], 1);
  assert.ok(Math.abs(shares("depth")[1] - 0.5) < 1e-6);
  assert.equal(shares("depth")[2], 0);
  assert.deepEqual(shares("height"), [1, 0.5, 0]);
});

test("a cut out of an image has all of the thing in it, with what is around it, and stays within the image", () => {
  const size = [300, 200] as const;
  for (const [u, v, wide, high] of [
    [800, 450, 20, 10],
    [3, 890, 1, 1],
    [100, 200, 1400, 30],
    [1590, 5, 4, 300],
  ]) {
    const places = new Float32Array([u, v, u + wide, v + high, Number.NaN, Number.NaN, 5, 5]);
    const region = regionOf(places, new Uint8Array([1, 1, 1, 0]));
    assert.deepEqual(region, { left: u, right: u + wide, top: v, bottom: v + high });
    const frame = around(region!, [1600, 900], size);
    const [x0, y0, x1, y1] = toScreen(frame, places);
    assert.ok(x0 >= 0 && y0 >= 0 && x1 <= 300 && y1 <= 200, `${x0} ${y0} ${x1} ${y1}`);
    const beside = frame.left > 1e-6 || frame.left + 1600 * frame.scale < 300 - 1e-6;
    assert.ok(!beside || 1600 * frame.scale <= 300, "nothing beside the image");
    assert.ok(Math.min(300 / frame.scale, 1600) >= 0.16 * 1600 - 1e-6, "what is around it");
  }
  assert.equal(regionOf(new Float32Array([Number.NaN, Number.NaN]), new Uint8Array([1])), null);
});

test("a thing's places come from whatever scans are on screen", () => {
  const cloud = buildCloud([made("a", 4, { x: [1, 2] }), made("b", 7, { x: [3, 4, 5] })]);
  const scans = [
    { radar: "b", scan: 7 },
    { radar: "a", scan: 9 },
    { radar: "a", scan: 4 },
  ];
  const columns = new Map<string, Column>([
    ["u", new Float32Array([10, 20, 30])],
    ["v", new Float32Array([11, 21, 31])],
    ["scan", new Uint32Array([0, 1, 2])],
    ["point", new Uint32Array([2, 0, 1])],
  ]);
  const table: Table<ThingInImageHeader> = { rows: 3, infos: [], header: { scans }, columns };
  const placed = placeThing(withoutPlaces(cloud.count), cloud, table);
  const none = Number.NaN;
  assert.deepEqual([...placed], [none, none, 30, 31, none, none, none, none, 10, 11]);
});
