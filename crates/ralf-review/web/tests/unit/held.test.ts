import assert from "node:assert/strict";
import { test } from "node:test";
import type { Column, Table } from "../../src/api/table.js";
import type { LidarHeader } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { heldLidar, heldStill, letGo, Path } from "../../src/data/held.js";
import { IDENTITY } from "../../src/data/transform.js";
import { made } from "./scans.js";

/** Nanoseconds. */
const at = (seconds: number): string => String(BigInt(Math.round(seconds * 1e9)));
const close = (a: ArrayLike<number>, b: readonly number[], within = 1e-3): void => {
  assert.equal(a.length, b.length);
  b.forEach((value, i) => assert.ok(Math.abs(a[i] - value) <= within, `${i}: ${a[i]}, ${value}`));
};
const xOf = (positions: Float32Array): number[] => [...positions].filter((_, i) => i % 3 === 0);

/** A car of 4 m that drives at 10 m/s: its ends are seen in turn, and always something that stands at 1 m. */
const SCANS = Array.from({ length: 11 }, (_, i) => {
  const car = 10 + i;
  return made("front", i, { x: [1, car, i % 2 === 0 ? car : car + 4], time: at(0.1 * i) });
});
const CLOUD = buildCloud(SCANS);
const CAR = new Uint8Array(CLOUD.count).map((_, i) => Number(i % 3 > 0));

test("what moves is held where it was first, and scans without it have no place", () => {
  const cloud = buildCloud([
    made("front", 0, { x: [1, 10, 12] }),
    made("front", 1, { x: [5, 20, 22], time: at(0.1) }),
    made("front", 2, { x: [7, 30], time: at(0.2) }),
  ]);
  const held = heldStill(cloud, new Uint8Array([0, 1, 1, 0, 1, 1, 0, 0]));
  close(xOf(held.positions).slice(0, 6), [1, 10, 12, -5, 10, 12]);
  assert.ok(xOf(held.positions).slice(6).every(Number.isNaN));
  assert.ok(held.held && !cloud.held && cloud.positions[9] === 5);
  assert.equal(heldStill(cloud, new Uint8Array(8)), cloud, "nothing is chosen");
  assert.deepEqual(letGo(held), cloud);
  assert.ok(held.measured === cloud.measured && letGo(held).measured === cloud.measured, "the same detections");
});

test("detections are where they are on what is held, whichever of its ends was seen", () => {
  const x = xOf(heldStill(CLOUD, CAR).positions);
  const rear = SCANS.map((_, i) => x[3 * i + 1]);
  assert.ok(Math.max(...rear) - Math.min(...rear) < 0.8, `${rear}`);
  close(
    SCANS.map((_, i) => x[3 * i + 2] - rear[i]),
    [0, 4, 0, 4, 0, 4, 0, 4, 0, 4, 0],
  );
});

/** What a LiDAR sees at a time: the car's rear and a post beside its way. */
function lidarAt(time: number, more: readonly number[] = []): Table<LidarHeader> {
  const x = new Float32Array([10 + 10 * time, 12, ...more]);
  const columns = new Map<string, Column>([
    ["x", x],
    ["y", new Float32Array(x.length).map((_, i) => (i === 1 ? 3 : 0))],
    ["z", new Float32Array(x.length)],
    ["ground", new Uint8Array(x.length)],
  ]);
  return { rows: x.length, infos: [], header: { t_ns: at(time), odom_from_vehicle: null }, columns };
}

test("LiDAR points of other times are where they are on it, one of each cell; what passes by is left out", () => {
  const path = Path.of(CLOUD, CAR);
  assert.ok(path !== null);
  const tables = [0.05, 0.25, 0.5, 0.75, 0.95].map((time) => lidarAt(time, [10.01 + 10 * time]));
  const lidar = heldLidar(tables, path, path.at(at(0)), null, { name: "top", scan: 3 });
  assert.ok(lidar.count >= 1 && lidar.count < 10, `${lidar.count}`);
  for (let i = 0; i < lidar.count; i++) {
    assert.ok(Math.abs(lidar.y[i]) < 1e-6, "the post is not on it");
    assert.ok(Math.abs(lidar.x[i] - 10) < 1.2, `${lidar.x[i]}`);
  }
  assert.deepEqual([lidar.name, lidar.scan, lidar.vehicleFromLidarTime], ["top", 3, IDENTITY]);
});

test("a path reaches as far as its detections, and knows when these were seen", () => {
  const path = Path.of(CLOUD, CAR);
  assert.deepEqual(path?.times, [0n, 1_000_000_000n]);
  assert.ok(path !== null && path.reach > 2 && path.reach < 6, `${path?.reach}`);
  assert.equal(Path.of(CLOUD, new Uint8Array(CLOUD.count)), null);
});
