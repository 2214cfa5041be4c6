/** The detections on screen: those of several scans, one after the other, in the vehicle frame of one of them. */

import { type Column, type ColumnGroup, floats } from "../api/table.js";
import type { ScanId, ScanPoints } from "../api/types.js";
import { classSource } from "./classes.js";
import { sameDetections, sameScan, type Scan, scanKey } from "./scan.js";
import { movePoints, targetFromSource } from "./transform.js";

export interface Cloud {
  /** The first is the one under review. */
  readonly scans: readonly Scan[];
  readonly count: number;
  /** Where each scan's detections begin. */
  readonly starts: readonly number[];
  /** Which of `scans` a detection belongs to. */
  readonly scanOf: Uint16Array;
  /** x, y, z of each detection, m, in the vehicle frame at the time of the scan under review. */
  readonly positions: Float32Array;
  /** The same as it was measured, whatever is held still: as long as this is the same, so are the detections. */
  readonly measured: Float32Array;
  readonly label: Uint16Array;
  readonly corrected: Uint8Array;
  /** Who tells the class of the label, as `classSource` has it. */
  readonly classFrom: Uint8Array;
  /** The number of the cause that a person said, or 0. */
  readonly saidCause: Uint8Array;
  /** False where the scans lie in different places and nothing says how the vehicle moved between them. */
  readonly compensated: boolean;
  /** True where scans are moved so that something that moves stays in its place. */
  readonly held: boolean;
}

const TOGETHER_NS = 1_000n;

export function buildCloud(scans: readonly Scan[]): Cloud {
  const starts: number[] = [];
  let count = 0;
  for (const scan of scans) {
    starts.push(count);
    count += scan.table.rows;
  }
  const scanOf = new Uint16Array(count);
  const positions = new Float32Array(3 * count);
  const target = scans[0]?.table.header.odom_from_vehicle ?? null;
  scans.forEach(({ table }, index) => {
    scanOf.fill(index, starts[index], starts[index] + table.rows);
    const motion = targetFromSource(target, table.header.odom_from_vehicle);
    movePoints(motion, [floats(table, "x"), floats(table, "y"), floats(table, "z")], positions, starts[index]);
  });
  const compensated =
    target !== null || scans.every(({ table }) => together(table.header.t_ns, scans[0].table.header.t_ns));
  const places = { positions, measured: positions, compensated, held: false };
  return { ...labelsOf(scans, count), ...places, scans, count, starts, scanOf };
}

/** The same cloud where some scans' labels are others; throws where their detections are. */
export function withScans(cloud: Cloud, changed: readonly Scan[]): Cloud {
  const scans = cloud.scans.map((scan) => changed.find((other) => sameScan(scan, other)) ?? scan);
  if (!holdsStill(cloud, scans)) throw new Error("scans: expected the detections that are on screen, found others");
  return { ...cloud, scans, ...labelsOf(scans, cloud.count) };
}

/** Whether scans that were read anew hold the detections that they have on screen. */
export function holdsStill(cloud: Cloud, read: readonly Scan[]): boolean {
  return cloud.scans.every((scan) => {
    const now = read.find((other) => sameScan(scan, other));
    return now === undefined || sameDetections(scan, now);
  });
}

/** A column of every scan, one after the other; NaN where a scan doesn't have it. */
export function gather(cloud: Cloud, name: string): Float32Array {
  const values = new Float32Array(cloud.count).fill(Number.NaN);
  cloud.scans.forEach(({ table }, index) => {
    const column = table.columns.get(name);
    if (column !== undefined) values.set(column, cloud.starts[index]);
  });
  return values;
}

/** A column that holds a number of each detection, and what the server says of it. */
export interface NumberColumn {
  readonly name: string;
  readonly unit: string;
  readonly meaning: string;
  readonly group: ColumnGroup;
}

/** The columns with a meaning, of the first scan's radar first. */
export function columnsOf({ scans }: Cloud): readonly NumberColumn[] {
  const columns = new Map<string, NumberColumn>();
  for (const { table } of scans) {
    for (const { name, unit = "", meaning = "", group } of table.infos) {
      if (group !== undefined && !columns.has(name)) columns.set(name, { name, unit, meaning, group });
    }
  }
  return [...columns.values()];
}

export function columnOf(cloud: Cloud, index: number, name: string): number {
  const scan = cloud.scanOf[index];
  const column: Column | undefined = cloud.scans[scan].table.columns.get(name);
  return column === undefined ? Number.NaN : column[index - cloud.starts[scan]];
}

export function pointOf(cloud: Cloud, index: number): { scan: Scan; point: number } {
  const scan = cloud.scanOf[index];
  return { scan: cloud.scans[scan], point: index - cloud.starts[scan] };
}

/** The chosen detections (1 in `mask`), scan by scan, as the server names them. */
export function pointsByScan(cloud: Cloud, mask: Uint8Array): readonly ScanPoints[] {
  const chosen: ScanPoints[] = [];
  cloud.scans.forEach(({ radar, scan, table }, index) => {
    const points: number[] = [];
    for (let point = 0; point < table.rows; point++) {
      if (mask[cloud.starts[index] + point] === 1) points.push(point);
    }
    if (points.length > 0) chosen.push({ radar, scan, points });
  });
  return chosen;
}

/** 1 for each of the named detections that is on screen. */
export function maskOf(cloud: Cloud, named: readonly ScanPoints[]): Uint8Array {
  const mask = new Uint8Array(cloud.count);
  for (const { radar, scan, points } of named) {
    const index = findScan(cloud, { radar, scan });
    if (index >= 0) for (const point of points) mask[cloud.starts[index] + point] = 1;
  }
  return mask;
}

/** Which scans are on screen, and which of them is under review. */
export function scansOf({ scans }: Cloud): string {
  return scans.map(scanKey).join();
}

export function findScan(cloud: Cloud, id: ScanId): number {
  return cloud.scans.findIndex((scan) => sameScan(scan, id));
}

function labelsOf(
  scans: readonly Scan[],
  count: number,
): Pick<Cloud, "label" | "corrected" | "classFrom" | "saidCause"> {
  const label = new Uint16Array(count);
  const corrected = new Uint8Array(count);
  const classFrom = new Uint8Array(count);
  const saidCause = new Uint8Array(count);
  let start = 0;
  for (const scan of scans) {
    label.set(scan.label, start);
    corrected.set(scan.corrected, start);
    saidCause.set(scan.saidCause, start);
    for (let point = 0; point < scan.table.rows; point++) classFrom[start + point] = classSource(scan, point);
    start += scan.table.rows;
  }
  return { label, corrected, classFrom, saidCause };
}

function together(a: string, b: string): boolean {
  const apart = BigInt(a) - BigInt(b);
  return apart <= TOGETHER_NS && apart >= -TOGETHER_NS;
}
