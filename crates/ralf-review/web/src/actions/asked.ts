/** What a question on screen is about. */

import { maskOf } from "../data/cloud.js";
import { within } from "../data/kinds.js";
import { pointsOf } from "../data/opinion.js";
import type { State } from "../state.js";

/** 1 for each detection on screen that the kind, disagreement or proposal is about; `null` where none is looked at. */
export function askedAbout({ cloud, kind, disputed, opinion }: Readonly<State>): Uint8Array | null {
  if (disputed !== null) return maskOf(cloud, disputed.points);
  if (kind !== null) return maskOf(cloud, within(kind));
  return opinion === null ? null : maskOf(cloud, pointsOf(opinion.changes));
}
