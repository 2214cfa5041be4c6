/** A rule asked of whole sequences, scan by scan: what it would change in each. */

import type { BaseRevision, Recording, ScanPoints, SequenceInfo } from "../api/types.js";
import { buildCloud, pointsByScan } from "./cloud.js";
import { type Filter, visible, type Certainty } from "./filter.js";
import type { LabelBook } from "./labels.js";
import { isAlready, type Verdict } from "./rules.js";
import type { Scan } from "./scan.js";

/** What a rule would change in one sequence. */
export interface ReplayPart {
  readonly sequence: string;
  readonly detections: number;
  /** What it lets through and is so already. */
  readonly already: number;
  /** What it lets through and somebody has said otherwise of, which stays. */
  readonly spared: number;
  readonly points: readonly ScanPoints[];
  /** Of the scans that it would change. */
  readonly base: readonly BaseRevision[];
  /** Why nothing is known of all of it. */
  readonly problem: string | null;
}

/** The sequences that somebody labels: those that were dealt to the person, or all where none were dealt. */
export function sequencesOf({ sequences }: Pick<Recording, "sequences">, person: string): readonly SequenceInfo[] {
  const labelled = sequences.filter(({ labelled: is }) => is);
  return labelled.some(({ assigned }) => assigned !== null)
    ? labelled.filter(({ assigned }) => assigned === person)
    : labelled;
}

/** What tells a rule's detections from the others of a scan. */
export interface Asking {
  readonly filter: Filter;
  readonly sets: Verdict;
  readonly labels: LabelBook;
  readonly certainty: Certainty;
  readonly causes: readonly string[];
}

/** Nothing of a sequence yet. */
export function nothingOf(sequence: string): ReplayPart {
  return { sequence, detections: 0, already: 0, spared: 0, points: [], base: [], problem: null };
}

/** The part with what a rule would change in one more scan. What somebody has corrected stays as it is. */
export function withScan(
  part: ReplayPart,
  scan: Scan,
  { filter, sets, labels, certainty, causes }: Asking,
): ReplayPart {
  const cloud = buildCloud([scan]);
  const passed = visible(cloud, filter, labels, certainty);
  let [already, spared] = [0, 0];
  const changed = passed.map((is, i) => {
    if (is === 0) return 0;
    if (isAlready(cloud, i, sets, causes)) already += 1;
    else if (cloud.corrected[i] === 1) spared += 1;
    else return 1;
    return 0;
  });
  const points = pointsByScan(cloud, changed);
  const { radar, scan: number, revision, table } = scan;
  const base = points.map(() => ({ radar, scan: number, revision, content: table.header.content }));
  return {
    ...part,
    detections: part.detections + points.reduce((sum, one) => sum + one.points.length, 0),
    already: part.already + already,
    spared: part.spared + spared,
    points: [...part.points, ...points],
    base: [...part.base, ...base],
  };
}
