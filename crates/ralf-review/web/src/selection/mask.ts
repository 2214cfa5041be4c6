/** Sets of detections as masks: 1 for those that belong. */

/** What a gesture does to the selection. */
export type Combination = "replace" | "add" | "remove";

export function combine(before: Uint8Array, gesture: Uint8Array, how: Combination): Uint8Array {
  if (how === "replace") return gesture;
  return before.map((chosen, i) => (how === "add" ? chosen | gesture[i] : chosen & (1 - gesture[i])));
}

/** Those among the eligible that weren't chosen. */
export function inverted(before: Uint8Array, eligible: Uint8Array): Uint8Array {
  return before.map((chosen, i) => eligible[i] & (1 - chosen));
}

export function intersection(a: Uint8Array, b: Uint8Array): Uint8Array {
  return a.map((value, i) => value & b[i]);
}

export function countOf(mask: Uint8Array): number {
  let count = 0;
  for (const chosen of mask) count += chosen;
  return count;
}
