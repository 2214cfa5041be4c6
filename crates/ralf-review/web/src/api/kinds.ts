/** Questions about many detections at once, as the server asks them. */

import type { BaseRevision, ScanId, ScanPoints } from "./types.js";

/** What the detections of a kind have in common. */
export type Sign = "moves" | "weak" | "ground" | "behind" | "free" | "again" | "rest";

/** Detections all over a sequence that one question is about. */
export interface AskedKind extends ScanId {
  /** Its name: kinds that were passed over are told to the server by it. */
  readonly kind: string;
  readonly sign: Sign;
  /** What the machine calls all of them. */
  readonly label: number;
  readonly detections: number;
  readonly things: number;
  readonly expected_errors: number;
  /** How many wrong labels fewer are expected once it is answered. */
  readonly worth: number;
  readonly points: readonly ScanPoints[];
  /** Of each detection of `points` in turn: how many of them all evidence contradicts more. */
  readonly ranks: readonly number[];
  /** So many of the first ranks are more probably wrong than right; once it is looked at, so many are asked about. */
  readonly asked: number;
}

/** The kind whose answer is worth most, and how many there are. */
export interface Kinds {
  readonly kinds: number;
  readonly next: AskedKind | null;
  /** Of every scan of the next one. */
  readonly base: readonly BaseRevision[];
  readonly scans: { readonly looked_at: number; readonly all: number };
}

/** A kind that is looked at. */
export interface Kind extends AskedKind, Pick<Kinds, "base" | "scans"> {
  /** How many kinds are left after it. */
  readonly left: number;
}
