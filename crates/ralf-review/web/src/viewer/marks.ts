/** How a detection stands out: the rim of its dot. */

import { type Cloud, gather } from "../data/cloud.js";
import { type Certainty, isUncertain } from "../data/filter.js";
import type { State } from "../state.js";

export type Marks = Uint8Array;

export const Mark = { plain: 0, uncertain: 1, corrected: 2, selected: 3, context: 4, hidden: 5, waiting: 6 } as const;

/** What strokes may change; beside what a question or a disagreement is about everything else is faint. */
export function nearOf({ kind, disputed, eligible, selection }: Readonly<State>): Uint8Array {
  return kind === null && disputed === null ? eligible : selection;
}

/** One mark per detection; the strongest that holds. */
export function marksOf(
  cloud: Cloud,
  masks: {
    readonly shown: Uint8Array;
    /** What strokes may change, or what is asked about: all else is faint. */
    readonly near: Uint8Array;
    readonly selection: Uint8Array;
    /** Those of strokes that aren't saved yet. */
    readonly waiting: Uint8Array;
  },
  certainty: Certainty,
): Marks {
  const [score, flags] = [gather(cloud, "w"), gather(cloud, "flags")];
  return new Uint8Array(cloud.count).map((_, i) => {
    if (masks.shown[i] === 0) return Mark.hidden;
    if (masks.selection[i] === 1) return Mark.selected;
    if (masks.waiting[i] === 1) return Mark.waiting;
    if (masks.near[i] === 0) return Mark.context;
    if (cloud.corrected[i] === 1) return Mark.corrected;
    return isUncertain(score[i], flags[i], certainty) ? Mark.uncertain : Mark.plain;
  });
}
