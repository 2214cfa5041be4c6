/** Scans made up for tests. */

import type { Column } from "../../src/api/table.js";
import { type Scan, scanFromTable } from "../../src/data/scan.js";

export interface Made {
  readonly x: readonly number[];
  readonly w?: readonly number[];
  readonly machine?: readonly number[];
  readonly classFrom?: readonly number[];
  readonly corrected?: readonly number[];
  readonly reviewed?: boolean;
  readonly odom?: readonly number[] | null;
  readonly time?: string;
  readonly content?: string;
  readonly run?: string;
}

export function made(
  radar: string,
  scan: number,
  { x, w, machine, classFrom, corrected, reviewed, odom = null, time = "0", content = "", run = "" }: Made,
): Scan {
  const zero = new Float32Array(x.length);
  const labels = new Uint16Array(machine ?? x.map(() => 99));
  const columns = new Map<string, Column>([
    ["x", new Float32Array(x)],
    ["y", zero],
    ["z", zero],
    ["range", new Float32Array(x)],
    ["w", new Float32Array(w ?? x.map(() => 0.9))],
    ["flags", new Uint16Array(x.length)],
    ["machine", labels],
    ["label", labels.slice()],
    ["corrected", new Uint8Array(corrected ?? x.map(() => 0))],
    ["class_from", new Uint8Array(classFrom ?? x.map(() => 0))],
    ["said_cause", new Uint8Array(x.length)],
  ]);
  const header = {
    t_ns: time,
    run,
    content,
    stamp: "",
    revision: 0,
    reviewed: reviewed === true ? { author: "ada", at: "" } : null,
    odom_from_vehicle: odom,
    origin: [0, 0, 0] as const,
    lidar: null,
    cameras: [],
    failed_cameras: [],
  };
  return scanFromTable({ radar, scan }, { rows: x.length, infos: [], header, columns });
}
