/** What two people said differently, and whose side is taken. */

import type { Disagreement } from "../api/types.js";
import { countOfPoints } from "../data/opinion.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";

export function settleBar({ store, actions }: Page): HTMLElement {
  const [what, left] = [h("b"), h("span", { class: "faint" })];
  const [first, second] = [h("span"), h("span")];
  const button = (text: HTMLElement | string, key: string, run: () => void): HTMLElement =>
    h("button", { class: "button", type: "button", on: { click: run } }, text, " ", h("kbd", {}, key));
  const bar = h(
    "div",
    { class: "settle-bar", role: "group", "aria-label": "What two people said differently" },
    h("div", { class: "thing-words", role: "status" }, what, left),
    button(first, "5", () => actions.settle.take("first")),
    button(second, "6", () => actions.settle.take("second")),
    button("Skip", "Shift S", () => void actions.settle.next()),
  );
  store.watch(
    ({ disputed, disagreements }) => [disputed, disagreements],
    (disputed, disagreements) => {
      bar.hidden = disputed === null;
      if (disputed === null) return;
      const { labels } = store.state;
      say(what, whatOf(disputed));
      say(left, `${counted(disagreements?.changes.length ?? 0, "disagreement")} left in this sequence`);
      say(first, `${firstOf(store.state)}: ${labels.name(disputed.first)}`);
      say(second, `${disputed.by}: ${labels.name(disputed.second)}`);
    },
  );
  return bar;
}

function whatOf({ points }: Disagreement): string {
  return `${counted(countOfPoints(points), "detection")} in ${counted(points.length, "scan")}`;
}

/** Whose labels count until somebody settles it. */
export function firstOf({ recording, sequence }: Readonly<State>): string {
  return recording.sequences.find(({ name }) => name === sequence)?.assigned ?? "First";
}
