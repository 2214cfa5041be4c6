/** What belongs together over a sequence, and which of it wants an answer most. */

import type { Table } from "../api/table.js";
import type { DoubtfulThing, ScanId, ScanPoints, ThingsHeader } from "../api/types.js";
import type { Cloud } from "./cloud.js";
import { scanKey } from "./scan.js";

/** How near to a place that was looked at things count as seen with it, m. */
export const SEEN_WITHIN = 9;

export class Things {
  private readonly byScan: ReadonlyMap<string, Uint32Array>;

  constructor(private readonly table: Table<ThingsHeader>) {
    const ids = table.columns.get("thing");
    if (!(ids instanceof Uint32Array)) throw new Error("table: expected the u32 column thing");
    let begin = 0;
    this.byScan = new Map(
      table.header.scans.map((scan) => [scanKey(scan), ids.subarray(begin, (begin += scan.rows))] as const),
    );
  }

  /** The run that they are of. */
  get run(): string {
    return this.table.header.run;
  }

  /** The thing of a scan's detection; -1 where none is known. */
  of(scan: ScanId, point: number): number {
    return this.byScan.get(scanKey(scan))?.[point] ?? -1;
  }

  /** All its detections, scan by scan. */
  members(thing: number): readonly ScanPoints[] {
    const found: ScanPoints[] = [];
    for (const { radar, scan } of this.table.header.scans) {
      const ids = this.byScan.get(scanKey({ radar, scan }));
      const points = ids === undefined ? [] : [...ids.keys()].filter((point) => ids[point] === thing);
      if (points.length > 0) found.push({ radar, scan, points });
    }
    return found;
  }
}

/** Everything shown of the things of the chosen detections. */
export function wholeThings(things: Things, cloud: Cloud, chosen: Uint8Array, shown: Uint8Array): Uint8Array {
  const thingOf = (index: number): number => {
    const scan = cloud.scanOf[index];
    return things.of(cloud.scans[scan], index - cloud.starts[scan]);
  };
  const wanted = new Set<number>();
  chosen.forEach((is, index) => {
    if (is === 1) wanted.add(thingOf(index));
  });
  wanted.delete(-1);
  if (wanted.size === 0) return chosen;
  return shown.map((is, index) => is & Number(wanted.has(thingOf(index))));
}

/** Where a person has looked, in the odometry frame, m. */
export type Place = readonly [x: number, y: number];

/**
 * The thing to be looked at next: where the most wrong labels are expected together, away from all places that were
 * looked at already.
 */
export function nextThing(doubtful: readonly DoubtfulThing[], seen: readonly Place[]): DoubtfulThing | null {
  const near = (a: Place, b: Place): boolean => Math.hypot(a[0] - b[0], a[1] - b[1]) <= SEEN_WITHIN;
  const open = doubtful.flatMap((thing) => {
    const at = placeOf(thing);
    return at === null || seen.some((place) => near(place, at)) ? [] : [{ thing, at }];
  });
  let best: { thing: DoubtfulThing; sum: number } | null = null;
  for (const { thing, at } of open) {
    const sum = open.reduce((all, other) => all + (near(other.at, at) ? other.thing.expected_errors : 0), 0);
    if (best === null || sum > best.sum) best = { thing, sum };
  }
  return best?.thing ?? null;
}

export function placeOf({ place: [x, y] }: DoubtfulThing): Place | null {
  return x === null || y === null ? null : [x, y];
}
