/** What the labels would be, after what people said: what of it stays when somebody leaves some out. */

import type { BaseRevision, Opinion, ProposedChange, ScanPoints } from "../api/types.js";
import { type Cloud, findScan } from "./cloud.js";
import { scanKey } from "./scan.js";

/** All detections that would change, scan by scan. */
export function pointsOf(changes: readonly ProposedChange[]): readonly ScanPoints[] {
  const byScan = new Map<string, ScanPoints>();
  for (const { radar, scan, points } of changes.flatMap((change) => change.points)) {
    const known = byScan.get(scanKey({ radar, scan }))?.points ?? [];
    byScan.set(scanKey({ radar, scan }), { radar, scan, points: [...known, ...points] });
  }
  return [...byScan.values()];
}

export function countOfPoints(points: readonly ScanPoints[]): number {
  return points.reduce((sum, one) => sum + one.points.length, 0);
}

/** Which part of a long sequence it is about, in words; nothing of a whole one. */
export function partOf({ scans }: Pick<Opinion, "scans">): string {
  if (scans === null || scans.looked_at === scans.all) return "";
  return ` in the ${scans.looked_at.toLocaleString("en")} of ${scans.all.toLocaleString("en")} scans around this one`;
}

/** The same without what is on screen and isn't selected any more. */
export function kept(opinion: Opinion, cloud: Cloud, selection: Uint8Array): Opinion {
  const changes = opinion.changes.flatMap((change) => {
    const points = keptPoints(change.points, cloud, selection);
    return points.length === 0 ? [] : [{ ...change, points }];
  });
  return { ...opinion, changes };
}

/** Of these, what isn't on screen, and what is and is selected. */
export function keptPoints(points: readonly ScanPoints[], cloud: Cloud, selection: Uint8Array): readonly ScanPoints[] {
  const selected = (part: ScanPoints): ScanPoints => {
    const at = findScan(cloud, part);
    if (at < 0) return part;
    return { ...part, points: part.points.filter((point) => selection[cloud.starts[at] + point] === 1) };
  };
  return points.map(selected).filter((part) => part.points.length > 0);
}

/** How many of the detections that would change are in scans that aren't on screen. */
export function countElsewhere({ changes }: Opinion, cloud: Cloud): number {
  return countOfPoints(pointsOf(changes).filter((part) => findScan(cloud, part) < 0));
}

/** What a stroke on these scans rests on: what was said when the opinion was made. */
export function baseOf({ base }: Pick<Opinion, "base">, points: readonly ScanPoints[]): readonly BaseRevision[] {
  const wanted = new Set(points.map(scanKey));
  return base.filter((one) => wanted.has(scanKey(one)));
}
