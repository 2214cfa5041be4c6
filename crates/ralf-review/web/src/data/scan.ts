/** One radar scan: its detections, and the labels they have now. */

import { floats, type Table } from "../api/table.js";
import type { Reviewed, ScanCorrections, ScanHeader, ScanId } from "../api/types.js";

export interface Scan extends ScanId {
  readonly table: Table<ScanHeader>;
  readonly revision: number;
  readonly reviewed: Reviewed | null;
  /** What the machine said. */
  readonly machine: Uint16Array;
  /** What holds now: a person's correction, else what was accepted with the scan, else the machine's. */
  readonly label: Uint16Array;
  /** 1 where a person set the label. */
  readonly corrected: Uint8Array;
  /** What tells the class of the machine's label: a place in the recording's `class_sources`. */
  readonly classFrom: Uint8Array;
  /** The number of the cause that a person said, or 0. */
  readonly saidCause: Uint8Array;
}

export function scanKey({ radar, scan }: ScanId): string {
  return `${radar}/${scan}`;
}

export function sameScan(a: ScanId | null, b: ScanId | null): boolean {
  return a !== null && b !== null && a.radar === b.radar && a.scan === b.scan;
}

/** Whether a detection has the label that somebody accepted with the scan, and the machine says otherwise by now. */
export function isAccepted({ reviewed, corrected, label, machine }: Scan, point: number): boolean {
  return reviewed !== null && corrected[point] === 0 && label[point] !== machine[point];
}

/** Whether both hold the same detections in the same places: the numbers of one mean the same in the other. */
export function sameDetections({ table: a }: Scan, { table: b }: Scan): boolean {
  if (a === b) return true;
  const [one, other] = [a.header, b.header];
  const moved = String(one.odom_from_vehicle) !== String(other.odom_from_vehicle);
  if (a.rows !== b.rows || one.content !== other.content || one.t_ns !== other.t_ns || moved) return false;
  return ["x", "y", "z"].every((name) => {
    const places = floats(b, name);
    return floats(a, name).every((value, i) => Object.is(value, places[i]));
  });
}

export function scanFromTable({ radar, scan }: ScanId, table: Table<ScanHeader>): Scan {
  floats(table, "x");
  return {
    radar,
    scan,
    table,
    revision: table.header.revision,
    reviewed: table.header.reviewed,
    machine: ids(table, "machine"),
    label: ids(table, "label"),
    corrected: bytes(table, "corrected"),
    classFrom: bytes(table, "class_from"),
    saidCause: bytes(table, "said_cause"),
  };
}

/**
 * The scan after a stroke, undo, or another's change. `null` where a mark was set or taken away, or a detection went
 * back from a correction in a scan that was accepted: what was accepted is the server's to say, so the scan must be
 * read anew.
 */
export function withCorrections(scan: Scan, { revision, corrections, causes, reviewed }: ScanCorrections): Scan | null {
  if ((reviewed === null) !== (scan.reviewed === null)) return null;
  const corrected = new Uint8Array(scan.corrected.length);
  for (const [point] of corrections) corrected[point] = 1;
  const label = scan.label.slice();
  for (let i = 0; i < label.length; i++) {
    if (scan.corrected[i] === 0 || corrected[i] === 1) continue;
    if (scan.reviewed !== null) return null;
    label[i] = scan.machine[i];
  }
  for (const [point, id] of corrections) label[point] = id;
  const saidCause = new Uint8Array(scan.corrected.length);
  for (const [point, cause] of causes) saidCause[point] = cause;
  return { ...scan, revision, label, corrected, saidCause, reviewed };
}

function ids(table: Table<ScanHeader>, name: string): Uint16Array {
  const column = table.columns.get(name);
  if (column instanceof Uint16Array) return column;
  throw new Error(`table: expected the u16 column ${name}`);
}

function bytes(table: Table<ScanHeader>, name: string): Uint8Array {
  const column = table.columns.get(name);
  if (column instanceof Uint8Array) return column;
  throw new Error(`table: expected the u8 column ${name}`);
}
