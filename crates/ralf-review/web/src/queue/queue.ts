/** The order of work: which scan is next, and how far the sequence is. */

import type { Progress, QueueScan, Reviewed, ScanCorrections, ScanId } from "../api/types.js";
import { sameScan } from "../data/scan.js";

export type QueueOrder = "need" | "time";

export interface QueueView {
  readonly order: QueueOrder;
  readonly hideReviewed: boolean;
  /** Only this radar's scans, or `null` for all. */
  readonly radar: string | null;
}

/** The scans as listed; the server sends those with the most expected errors first. */
export function listed(scans: readonly QueueScan[], view: QueueView): readonly QueueScan[] {
  const kept = scans.filter(
    ({ radar, reviewed }) => (view.radar === null || radar === view.radar) && !(view.hideReviewed && reviewed !== null),
  );
  return view.order === "need" ? kept : [...kept].sort(byTime);
}

/** The next scan that nobody has reviewed: the one after the current by need, and from the top again after the last. */
export function nextNeedy(scans: readonly QueueScan[], current: ScanId | null): QueueScan | null {
  const at = scans.findIndex((entry) => sameScan(entry, current));
  const inTurn = [...scans.slice(at + 1), ...scans.slice(0, Math.max(at, 0))];
  return inTurn.find(({ reviewed }) => reviewed === null) ?? null;
}

/** The scan so many steps later (or earlier) of the same radar. */
export function neighbour(scans: readonly QueueScan[], current: ScanId, step: number): QueueScan | null {
  const ofRadar = scans.filter(({ radar }) => radar === current.radar).sort(byTime);
  const at = ofRadar.findIndex((entry) => sameScan(entry, current));
  return at < 0 ? null : (ofRadar[at + step] ?? null);
}

/** Why a scan needs a person, most telling first. */
export function reasons({ uncertain, disagreeing, cameras_failed: failed }: QueueScan): readonly string[] {
  const said: string[] = [];
  if (failed > 0) said.push(failed === 1 ? "camera failed" : `${failed} cameras failed`);
  if (uncertain > 0) said.push(`${uncertain} uncertain`);
  if (disagreeing > 0) said.push(`${disagreeing} disagree`);
  return said;
}

/** A scan's entry now, by which its place is kept. */
export function keptPlace(scans: readonly QueueScan[], current: ScanId | null): QueueScan | null {
  return scans.find((entry) => sameScan(entry, current)) ?? null;
}

/**
 * Scans in the server's order, but for the one that is looked at: it stays where `place` was, as long as it is looked
 * at, so that the next one is the next one, whatever is said of this one meanwhile.
 */
export function withPlaceKept(scans: readonly QueueScan[], place: QueueScan | null): readonly QueueScan[] {
  const now = place === null ? undefined : scans.find((entry) => sameScan(entry, place));
  if (place === null || now === undefined) return scans;
  const others = scans.filter((entry) => entry !== now);
  const behind = others.findIndex((entry) => inOrder(place, entry) < 0);
  return behind < 0 ? [...others, now] : [...others.slice(0, behind), now, ...others.slice(behind)];
}

/** The server's order: what nobody reviewed first, then what has the most expected errors, then by time. */
function inOrder(a: QueueScan, b: QueueScan): number {
  const done = Number(a.reviewed !== null) - Number(b.reviewed !== null);
  return done !== 0 ? done : b.expected_errors - a.expected_errors || byTime(a, b);
}

export function withAnswers(scans: readonly QueueScan[], answered: readonly ScanCorrections[]): readonly QueueScan[] {
  return scans.map((entry) => {
    const answer = answered.find((other) => sameScan(other, entry));
    return answer === undefined ? entry : { ...entry, corrected: answer.corrections.length, reviewed: answer.reviewed };
  });
}

export function withReviewed(scans: readonly QueueScan[], id: ScanId, reviewed: Reviewed | null): readonly QueueScan[] {
  return scans.map((entry) => (sameScan(entry, id) ? { ...entry, reviewed } : entry));
}

export function progressOf(scans: readonly QueueScan[], before: Progress): Progress {
  return {
    scans: scans.length,
    reviewed: scans.filter(({ reviewed }) => reviewed !== null).length,
    corrected_detections: scans.reduce((sum, { corrected }) => sum + corrected, 0),
    orphaned_scans: before.orphaned_scans,
  };
}

function byTime(a: QueueScan, b: QueueScan): number {
  const apart = BigInt(a.t_ns) - BigInt(b.t_ns);
  if (apart !== 0n) return apart < 0n ? -1 : 1;
  return a.radar < b.radar ? -1 : Number(a.radar > b.radar);
}
