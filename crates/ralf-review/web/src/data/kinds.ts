/** Where the line is drawn in a kind between what is asked about and what stays as it is. */

import type { AskedKind } from "../api/kinds.js";
import type { ScanPoints } from "../api/types.js";

/** A person sees the difference between so many lines. */
const LINES = 20;

/** How many detections may be asked about, the fewest first. */
export function linesOf(detections: number): readonly number[] {
  const counts = Array.from({ length: LINES }, (_, i) => Math.max(1, Math.round((detections * (i + 1)) / LINES)));
  return [...new Set(counts)];
}

/** The place among the lines of the first with at least so many detections. */
export function lineAt(lines: readonly number[], asked: number): number {
  const at = lines.findIndex((count) => count >= asked);
  return at < 0 ? lines.length - 1 : at;
}

/** Those of a kind that are asked about. */
export function within({ points, ranks, asked }: Pick<AskedKind, "points" | "ranks" | "asked">): readonly ScanPoints[] {
  let begin = 0;
  const parts = points.map((part) => {
    const first = begin;
    begin += part.points.length;
    return { ...part, points: part.points.filter((_, i) => ranks[first + i] < asked) };
  });
  return parts.filter((part) => part.points.length > 0);
}
