/** What two people said differently, and whose side is taken. */

import type { Disagreement } from "../api/types.js";
import { type Outlook, outlookOf } from "../data/team.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import { keyButton } from "./buttons.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";

export function settleBar({ store, actions }: Page): HTMLElement {
  const [what, left, spared] = [h("b"), h("span", { class: "faint" }), h("span", { class: "spared" })];
  const [first, second] = [h("span"), h("span")];
  const showAll = keyButton("Show them", "0", () => actions.settle.showAll());
  const bar = h(
    "div",
    { class: "settle-bar", role: "group", "aria-label": "What two people said differently" },
    h("div", { class: "thing-words", role: "status" }, what, spared, left),
    showAll,
    keyButton(first, "5", () => actions.settle.take("first")),
    keyButton(second, "6", () => actions.settle.take("second")),
    keyButton("Skip", "Shift S", () => void actions.settle.next()),
  );
  store.watch(
    ({ disputed, disagreements, cloud, selection, shown, eligible }) => [
      disputed,
      disagreements,
      cloud,
      selection,
      shown,
      eligible,
    ],
    (disputed, disagreements, cloud, selection) => {
      bar.hidden = disputed === null || selection.length !== cloud.count;
      if (disputed === null || bar.hidden) return;
      const { labels } = store.state;
      const outlook = outlookOf(disputed, store.state);
      say(what, whatOf(disputed, outlook));
      say(spared, sparedOf(outlook));
      for (const one of [spared, showAll]) one.hidden = sparedOf(outlook) === "";
      say(left, `${counted(disagreements?.changes.length ?? 0, "disagreement")} left in this sequence`);
      say(first, `${firstOf(store.state)}: ${labels.nameWith(disputed.first, disputed.first_cause)}`);
      say(second, `${disputed.by}: ${labels.nameWith(disputed.second, disputed.second_cause)}`);
    },
  );
  return bar;
}

function whatOf({ points }: Disagreement, { all, settled, elsewhere }: Outlook): string {
  const some = settled < all ? `${settled.toLocaleString("en")} of ` : "";
  const beyond = elsewhere === 0 ? "" : `, ${elsewhere.toLocaleString("en")} of them not on screen`;
  return `${some}${counted(all, "detection")} in ${counted(points.length, "scan")}${beyond}`;
}

/** What is left although nobody spared it. */
function sparedOf({ unshown, unreached }: Outlook): string {
  const reasons = [
    ...(unshown === 0 ? [] : [`the filter hides ${unshown.toLocaleString("en")}`]),
    ...(unreached === 0 ? [] : [`${unreached.toLocaleString("en")} lie in other scans than this`]),
  ];
  return reasons.length === 0 ? "" : `Left as they are: ${reasons.join(", ")}`;
}

/** Whose labels count until somebody settles it. */
export function firstOf({ recording, sequence }: Readonly<State>): string {
  return recording.sequences.find(({ name }) => name === sequence)?.assigned ?? "First";
}
