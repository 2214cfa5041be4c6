/** Which detections are shown. */

import type { Recording } from "../api/types.js";
import type { Area } from "./area.js";
import { gather, type Cloud, pointOf } from "./cloud.js";
import type { LabelBook } from "./labels.js";
import { isAccepted } from "./scan.js";

export type Span = readonly [least: number, most: number];
export type Origin = "any" | "corrected" | "machine";

/** Values of a column; a detection without one doesn't pass. */
export interface ColumnSpan {
  readonly name: string;
  readonly span: Span;
}

export interface Filter {
  readonly plausible: boolean;
  readonly artifact: boolean;
  readonly unlabelled: boolean;
  readonly origin: Origin;
  /** Only those so near the threshold that the machine isn't sure. */
  readonly uncertain: boolean;
  /** Plausibility; detections without one pass only the whole range. */
  readonly score: Span;
  readonly range: Span;
  readonly height: Span;
  /** Flags of which a detection must have at least one; 0: whatever they are. */
  readonly flags: number;
  /** Label ids of which a detection must have one; empty: whatever its class is. */
  readonly classes: ReadonlySet<number>;
  /** Who may tell its class, as `classSource` has it; empty: whoever does. */
  readonly classFrom: ReadonlySet<number>;
  readonly hiddenRadars: ReadonlySet<string>;
  /** Whatever else is asked of numbers. */
  readonly columns: readonly ColumnSpan[];
  /** Places in the world; all of them must hold. */
  readonly areas: readonly Area[];
}

export const everything: Filter = {
  plausible: true,
  artifact: true,
  unlabelled: true,
  origin: "any",
  uncertain: false,
  score: [0, 1],
  range: [0, Infinity],
  height: [-Infinity, Infinity],
  flags: 0,
  classes: new Set(),
  classFrom: new Set(),
  hiddenRadars: new Set(),
  columns: [],
  areas: [],
};

/** Scores no farther from the threshold than this are uncertain, as in the queue. */
export const UNCERTAIN_WITHIN = 0.1;

/** Near the threshold, unless flags settle the label whatever the score (`decided`: the bits of these together). */
export function isUncertain(score: number, flags: number, { threshold, decided }: Certainty): boolean {
  return Math.abs(score - threshold) <= UNCERTAIN_WITHIN && (flags & decided) !== decided;
}

/** What the machine is sure by. */
export interface Certainty {
  readonly threshold: number;
  readonly decided: number;
}

export function certaintyOf({ threshold, flags }: Pick<Recording, "threshold" | "flags">): Certainty {
  const decided = flags.reduce((bits, flag) => (flag.decided ? bits | flag.bit : bits), 0);
  return { threshold, decided };
}

/** 1 for each detection that passes. */
export function visible(cloud: Cloud, filter: Filter, labels: LabelBook, certainty: Certainty): Uint8Array {
  const shown = new Uint8Array(cloud.count);
  const [score, range, flags] = ["w", "range", "flags"].map((name) => gather(cloud, name));
  const columns = filter.columns.map(({ name, span }) => ({ values: gather(cloud, name), span }));
  const shownScans = cloud.scans.map(({ radar }) => !filter.hiddenRadars.has(radar));
  const anyScore = filter.score[0] <= 0 && filter.score[1] >= 1;
  for (let i = 0; i < cloud.count; i++) {
    const corrected = cloud.corrected[i] === 1;
    shown[i] = Number(
      shownScans[cloud.scanOf[i]] &&
        filter[labels.truth(cloud.label[i])] &&
        (filter.origin === "any" || isBy(filter.origin, cloud, i)) &&
        (!filter.uncertain || (!corrected && isUncertain(score[i], flags[i], certainty))) &&
        (anyScore || within(score[i], filter.score)) &&
        within(range[i], filter.range) &&
        within(cloud.positions[3 * i + 2], filter.height) &&
        (filter.flags === 0 || (flags[i] & filter.flags) !== 0) &&
        (filter.classes.size === 0 || filter.classes.has(cloud.label[i])) &&
        (filter.classFrom.size === 0 || filter.classFrom.has(cloud.classFrom[i])) &&
        columns.every(({ values, span }) => within(values[i], span)),
    );
  }
  return shown;
}

/** Whether the filter hides anything at all. */
export function hides(filter: Filter): boolean {
  return (Object.keys(everything) as (keyof Filter)[]).some((key) => {
    const [now, whole] = [filter[key], everything[key]];
    if (now instanceof Set) return now.size > 0;
    if (key === "columns" || key === "areas") return filter[key].length > 0;
    return Array.isArray(now) ? String(now) !== String(whole) : now !== whole;
  });
}

function isBy(origin: Origin, cloud: Cloud, index: number): boolean {
  if (cloud.corrected[index] === 1) return origin === "corrected";
  const { scan, point } = pointOf(cloud, index);
  return origin === "machine" && !isAccepted(scan, point);
}

function within(value: number, [least, most]: Span): boolean {
  return value >= least && value <= most;
}
