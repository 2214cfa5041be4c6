/** What people who label together have done, and where they disagree. */

import type { Agreement, Disagreement, Saying, Workday } from "../api/types.js";
import { type Cloud, findScan, maskOf } from "./cloud.js";
import { counted } from "../format.js";
import { countOfPoints, keptPoints } from "./opinion.js";

/** What tells one disagreement from all others of the sequence. */
export function keyOf({ thing, first, second, first_cause, second_cause, by }: Disagreement): string {
  return [thing, first, second, first_cause, second_cause, by].join();
}

/** The first that wasn't looked at yet; when all were, the first of those that are left. */
export function nextDisagreement(all: readonly Disagreement[], seen: Set<string>): Disagreement | null {
  const fresh = all.find((one) => !seen.has(keyOf(one)));
  if (fresh === undefined) seen.clear();
  return fresh ?? all[0] ?? null;
}

/** How many detections of a disagreement would be settled now, and how many not. */
export interface Outlook {
  readonly all: number;
  readonly settled: number;
  /** Of these, the ones in scans that aren't on screen. */
  readonly elsewhere: number;
  /** Left, for the filter hides them. */
  readonly unshown: number;
  /** Left, for strokes change the scan under review alone. */
  readonly unreached: number;
}

export function outlookOf(
  { points }: Disagreement,
  screen: Readonly<Record<"shown" | "eligible" | "selection", Uint8Array>> & { readonly cloud: Cloud },
): Outlook {
  const { cloud, shown, eligible, selection } = screen;
  const elsewhere = countOfPoints(points.filter((part) => findScan(cloud, part) < 0));
  const [all, settled] = [countOfPoints(points), countOfPoints(keptPoints(points, cloud, selection))];
  let [unshown, unreached] = [0, 0];
  maskOf(cloud, points).forEach((is, i) => {
    if (is === 0 || eligible[i] === 1) return;
    if (shown[i] === 1) unreached += 1;
    else unshown += 1;
  });
  return { all, settled, elsewhere, unshown, unreached };
}

/** Whether it marks a scan, and says nothing of single detections. */
export function isMark({ tool }: Saying): boolean {
  return tool === "reviewed" || tool === "unreviewed";
}

/** The same with marks that somebody set one after the other told as one. */
export function withMarksTogether(said: readonly Saying[]): readonly Saying[] {
  const told: Saying[] = [];
  for (const saying of said) {
    const last = told.at(-1);
    const same = last !== undefined && last.author === saying.author && last.tool === saying.tool;
    if (same && isMark(saying) && last.holds === saying.holds)
      told[told.length - 1] = { ...last, detections: last.detections + saying.detections };
    else told.push(saying);
  }
  return told;
}

/** What somebody has done over all days. */
export interface Person {
  readonly name: string;
  readonly second: boolean;
  readonly days: number;
  readonly detections: number;
  readonly scans: number;
  readonly hours: number;
}

/** Each person once for first labels and once for second ones, in the order in which they come. */
export function peopleOf(days: readonly Workday[]): readonly Person[] {
  const people = new Map<string, Person>();
  for (const { author, second, detections, scans, worked_s } of days) {
    const key = `${second} ${author}`;
    const known = people.get(key) ?? { name: author, second, days: 0, detections: 0, scans: 0, hours: 0 };
    people.set(key, {
      ...known,
      days: known.days + 1,
      detections: known.detections + detections,
      scans: known.scans + scans,
      hours: known.hours + worked_s / 3600,
    });
  }
  return [...people.values()];
}

/** Whose scans an agreement is about, with those that don't count. */
export function comparedScans(first: string, { second, scans, left_out: others }: Agreement): string {
  const left = others === 0 ? "" : `; ${counted(others, "scan")} not dealt to ${second} left out`;
  return `${first} and ${second}, ${counted(scans, "scan")}${left}`;
}

/** What was done in less says nothing of an hour, h. */
const LEAST_HOURS = 0.05;

/** How many in an hour; NaN where it took too little time to tell. */
export function perHour(count: number, hours: number): number {
  return hours >= LEAST_HOURS ? count / hours : Number.NaN;
}
