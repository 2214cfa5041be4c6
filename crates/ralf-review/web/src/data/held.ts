/** What moves, held still: detections and LiDAR points of other times where they are on it. */

import type { Table } from "../api/table.js";
import { floats } from "../api/table.js";
import type { LidarHeader } from "../api/types.js";
import type { Cloud } from "./cloud.js";
import type { Lidar } from "./lidar.js";
import { IDENTITY, movePoints, targetFromSource, type Vector } from "./transform.js";

/** How much of the time around says where a thing is at a moment, s: the middle of its detections jumps about. */
const SMOOTHED_S = 0.8;
/** The LiDAR's points are those within what its detections span, and this much around, m. */
const AROUND = 1.5;
const FARTHEST = 15;
/** One point is kept of each cell this wide, m. */
const CELL = 0.06;
/** What several scans have not seen in a cell this wide passes by, m. */
const SUPPORT = 0.2;
const LEAST_SCANS = 3;

/** What is held at one time: seconds since the first scan, and the middle of so many detections, m. */
interface Sighting {
  readonly time: number;
  readonly middle: Vector;
  readonly count: number;
}

/** Where what is held was over time, in the vehicle frame of the scan under review, m. */
export class Path {
  private constructor(
    private readonly sightings: readonly Sighting[],
    private readonly zero: bigint,
    /** How far its detections reach from there, m. */
    readonly reach: number,
  ) {}

  /** The path of what is chosen; `null` where nothing is. */
  static of(cloud: Cloud, chosen: Uint8Array): Path | null {
    const zero = BigInt(cloud.scans[0]?.table.header.t_ns ?? 0);
    const sightings = cloud.scans.flatMap(({ table }, scan) => {
      const middle = middleOf(cloud, scan, chosen);
      return middle === null ? [] : [{ ...middle, time: seconds(table.header.t_ns, zero) }];
    });
    if (sightings.length === 0) return null;
    const path = new Path(sightings, zero, 0);
    return new Path(sightings, zero, path.reachOf(cloud, chosen));
  }

  /** The first and the last time that it was seen, ns. */
  get times(): readonly [bigint, bigint] {
    const times = this.sightings.map(({ time }) => time);
    const at = (time: number): bigint => this.zero + BigInt(Math.round(time * 1e9));
    return [at(Math.min(...times)), at(Math.max(...times))];
  }

  /** Where it is: the line that the sightings around this time follow best, the nearest ones most. */
  at(t_ns: string): Vector {
    const now = seconds(t_ns, this.zero);
    const weighed = this.sightings.map((sighting) => {
      const apart = (sighting.time - now) / SMOOTHED_S;
      return { ...sighting, apart, weight: sighting.count * Math.exp(-0.5 * apart * apart) + Number.MIN_VALUE };
    });
    const mean = (value: (one: (typeof weighed)[number]) => number): number => {
      const all = weighed.reduce((sum, { weight }) => sum + weight, 0);
      return weighed.reduce((sum, one) => sum + (one.weight / all) * value(one), 0);
    };
    const [time, square] = [mean(({ apart }) => apart), mean(({ apart }) => apart * apart)];
    const spread = square - time * time;
    const axis = (at: 0 | 1 | 2): number => {
      const value = mean(({ middle }) => middle[at]);
      const slope = spread < 1e-3 ? 0 : (mean(({ middle, apart }) => middle[at] * apart) - value * time) / spread;
      return value - slope * time;
    };
    return [axis(0), axis(1), axis(2)];
  }

  /** How far nine tenths of the detections are from it at most. */
  private reachOf({ scans, starts, measured }: Cloud, chosen: Uint8Array): number {
    const far = scans.flatMap(({ table }, scan) => {
      const rows = Array.from({ length: table.rows }, (_, row) => starts[scan] + row).filter((i) => chosen[i] === 1);
      if (rows.length === 0) return [];
      const [x, y] = this.at(table.header.t_ns);
      return rows.map((i) => Math.hypot(measured[3 * i] - x, measured[3 * i + 1] - y));
    });
    far.sort((a, b) => a - b);
    return Math.min(far[Math.floor(0.9 * (far.length - 1))] + AROUND, FARTHEST);
  }
}

/**
 * The scans moved (and not turned) as what is chosen moves, so that it is always where it is in the first scan that has
 * some of it. Those without any of it have no place. The same cloud where nothing is chosen.
 */
export function heldStill(cloud: Cloud, chosen: Uint8Array): Cloud {
  const path = Path.of(cloud, chosen);
  if (path === null) return cloud;
  const anchor = path.at(anchorTime(cloud, chosen));
  const moved = cloud.measured.slice();
  cloud.scans.forEach(({ table }, scan) => {
    const there = middleOf(cloud, scan, chosen) === null ? null : path.at(table.header.t_ns);
    for (let at = 3 * cloud.starts[scan]; at < 3 * (cloud.starts[scan] + table.rows); at++) {
      const axis = at % 3;
      moved[at] = there === null ? Number.NaN : moved[at] - there[axis] + anchor[axis];
    }
  });
  return { ...cloud, positions: moved, held: true };
}

/** The same detections where they were measured. */
export function letGo(cloud: Cloud): Cloud {
  return { ...cloud, positions: cloud.measured, held: false };
}

/** When what is held is where it stays. */
export function anchorTime(cloud: Cloud, chosen: Uint8Array): string {
  const first = cloud.scans.find((_, scan) => middleOf(cloud, scan, chosen) !== null);
  return first?.table.header.t_ns ?? "0";
}

/**
 * LiDAR points around what is held, of several times, where they are on it, in the vehicle frame of the scan under
 * review: one of each cell, and none of a cell that only few scans have seen something in.
 */
export function heldLidar(
  tables: readonly Table<LidarHeader>[],
  path: Path,
  anchor: Vector,
  odomFromTarget: readonly number[] | null,
  of: Pick<Lidar, "name" | "scan">,
): Lidar {
  const found = new Cells();
  tables.forEach((table, scan) => {
    const places = new Float32Array(3 * table.rows);
    const motion = targetFromSource(odomFromTarget, table.header.odom_from_vehicle);
    movePoints(motion, [floats(table, "x"), floats(table, "y"), floats(table, "z")], places, 0);
    const there = path.at(table.header.t_ns);
    const ground = table.columns.get("ground");
    for (let i = 0; i < table.rows; i++) {
      const on = [0, 1, 2].map((axis) => places[3 * i + axis] - there[axis]) as [number, number, number];
      found.add(on, scan, ground?.[i] ?? 0);
    }
  });
  const kept = found.kept(Math.min(LEAST_SCANS, tables.length));
  const column = (axis: 0 | 1 | 2): Float32Array => new Float32Array(kept.map(({ on }) => on[axis] + anchor[axis]));
  const ground = new Uint8Array(kept.map((point) => point.ground));
  const columns = { x: column(0), y: column(1), z: column(2), ground };
  return { ...of, ...columns, count: kept.length, vehicleFromLidarTime: IDENTITY };
}

interface OnIt {
  readonly on: Vector;
  readonly ground: number;
}

/** Points by cells, and by which scans wider cells were seen. */
class Cells {
  private readonly points = new Map<number, OnIt>();
  private readonly seen = new Map<number, Set<number>>();

  add(on: Vector, scan: number, ground: number): void {
    const cell = cellOf(on, CELL);
    if (!this.points.has(cell)) this.points.set(cell, { on, ground });
    const wide = cellOf(on, SUPPORT);
    const scans = this.seen.get(wide);
    if (scans === undefined) this.seen.set(wide, new Set([scan]));
    else scans.add(scan);
  }

  kept(least: number): readonly OnIt[] {
    return [...this.points.values()].filter(({ on }) => (this.seen.get(cellOf(on, SUPPORT))?.size ?? 0) >= least);
  }
}

/** A number for each cell: nothing is farther from what is held than some hundred cells. */
function cellOf(on: Vector, width: number): number {
  return on.reduce((number, metres) => 8192 * number + Math.floor(metres / width) + 4096, 0);
}

function seconds(t_ns: string, zero: bigint): number {
  return Number(BigInt(t_ns) - zero) * 1e-9;
}

/** Where the chosen detections of a scan lie on average, m, and how many these are; `null` where none is chosen. */
function middleOf({ starts, scans, measured }: Cloud, scan: number, chosen: Uint8Array): Omit<Sighting, "time"> | null {
  const sum: [number, number, number] = [0, 0, 0];
  let count = 0;
  for (let i = starts[scan]; i < starts[scan] + scans[scan].table.rows; i++) {
    if (chosen[i] === 0) continue;
    count += 1;
    for (const axis of [0, 1, 2]) sum[axis] += measured[3 * i + axis];
  }
  const [x, y, z] = sum.map((value) => value / count);
  return count === 0 ? null : { middle: [x, y, z], count };
}
