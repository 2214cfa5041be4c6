/** What somebody is told who has to decide about a conflict. */

import { type Cloud, maskOf } from "../data/cloud.js";
import type { LabelBook } from "../data/labels.js";
import { sameScan } from "../data/scan.js";
import { clock, counted } from "../format.js";
import { countOf, intersection } from "../selection/mask.js";
import { type Met, pointsIn } from "./outbox.js";

/** What is on screen. */
export interface Picture {
  readonly sequence: string;
  readonly cloud: Cloud;
  readonly selection: Uint8Array;
}

/** Who is asked, and with what words. */
export interface Asked extends Picture {
  readonly labels: LabelBook;
  readonly name: string;
}

/** Whether the stroke's detections are on screen, and selected. */
export function isShown({ pending }: Met, { sequence, cloud, selection }: Picture): boolean {
  const its = maskOf(cloud, pointsIn(sequence, cloud.scans, [pending]));
  const count = countOf(its);
  return count > 0 && countOf(intersection(its, selection)) === count;
}

/** Sentences: who was faster, what waits, and what is on screen of it. */
export function toldOf(met: Met, seen: Asked): readonly string[] {
  const { sequence, stroke } = met.pending;
  const where = sequence === seen.sequence ? "" : ` in sequence ${sequence}`;
  const who = whoFirst(met, where, seen.name);
  if (met.body.stale) return [who, `Your stroke${where} was made on what was there before. Nothing of it is saved.`];
  const count = stroke.points.reduce((sum, { points }) => sum + points.length, 0);
  const wanted = `${counted(count, "detection")}${where} to ${seen.labels.choiceName(stroke.label)}`;
  const touched = countTouched(met);
  const corrected = `${touched === 0 ? "none" : touched} of them ${touched === 1 ? "is" : "are"} corrected there`;
  const shown = isShown(met, seen) ? "The picture shows" : "“Show it” puts on screen";
  return [
    who,
    `Your ${stroke.tool} sets ${wanted}. Nothing of it is saved yet.`,
    `${shown} the newer state, with your detections selected; ${corrected}.`,
  ];
}

function whoFirst({ body: { conflict, error } }: Met, where: string, name: string): string {
  if (conflict === null) return error;
  const { author, radar, scan, tool, at } = conflict;
  const elsewhere = author === name ? " (in another window)" : "";
  return `${author}${elsewhere} changed ${radar} ${scan}${where} with ${tool}, ${clock(at)}.`;
}

/** How many of the stroke's detections are corrected in the newer state. */
function countTouched({ body, pending }: Met): number {
  return pending.stroke.points.reduce((sum, { radar, scan, points }) => {
    const newer = body.scans.find((other) => sameScan(other, { radar, scan }));
    const now = new Set(newer?.corrections.map(([point]) => point));
    return sum + points.filter((point) => now.has(point)).length;
  }, 0);
}
