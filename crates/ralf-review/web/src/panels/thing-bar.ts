/** The thing that wants an answer: what it is, what speaks for and against it, and the two answers. */

import { type Cloud, gather } from "../data/cloud.js";
import { ARTIFACT, PLAUSIBLE } from "../data/labels.js";
import { h, say } from "../dom.js";
import { counted, decimal } from "../format.js";
import type { Page } from "../page.js";
import { keyButton } from "./buttons.js";
import { selectedText } from "./status-bar.js";

export function thingBar({ store, actions }: Page): HTMLElement {
  const [what, why] = [h("b"), h("span", { class: "faint" })];
  const bar = h(
    "div",
    { class: "thing-bar", role: "group", "aria-label": "The thing that wants an answer" },
    h("div", { class: "thing-words" }, what, why),
    keyButton("Plausible", "P", () => actions.select.choose(PLAUSIBLE)),
    keyButton("Artifact", "A", () => actions.select.choose(ARTIFACT)),
    keyButton("Skip", "Shift N", () => void actions.thing.next()),
  );
  store.watch(
    ({ thing, selection, cloud, labels }) => [thing, selection, cloud, labels],
    (thing, selection, cloud, labels) => {
      bar.hidden = thing === null;
      bar.dataset["thing"] = thing === null ? "" : String(thing.thing);
      if (thing === null || selection.length !== cloud.count) return;
      say(what, selectedText(selection, cloud, labels));
      say(why, [`${thing.expected_errors.toFixed(1)} expected to be wrong`, ...evidence(cloud, selection)].join(" · "));
    },
  );
  return bar;
}

/** What the branches and the radar say of the selected, on average, in words. */
export function evidence(cloud: Cloud, selection: Uint8Array): readonly string[] {
  const branches = [
    ["w_lm", "LiDAR"],
    ["w_cm", "camera"],
    ["w_tr", "tracking"],
  ] as const;
  const said = branches.flatMap(([name, text]) => {
    const { mean, count } = averaged(gather(cloud, name), selection);
    if (count === 0) return [];
    const verdict = mean >= 0.65 ? "for it" : mean <= 0.35 ? "against it" : "undecided";
    return [`${text} ${verdict} (${decimal(mean, 2)} of ${counted(count, "detection")})`];
  });
  const heights = new Float32Array(cloud.count).map((_, i) => cloud.positions[3 * i + 2]);
  const height = averaged(heights, selection);
  return height.count === 0 ? said : [...said, `${decimal(height.mean, 1)} m high`];
}

function averaged(values: Float32Array, chosen: Uint8Array): { readonly mean: number; readonly count: number } {
  let [sum, count] = [0, 0];
  chosen.forEach((is, i) => {
    if (is === 0 || Number.isNaN(values[i])) return;
    sum += values[i];
    count += 1;
  });
  return { mean: sum / count, count };
}
