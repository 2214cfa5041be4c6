/** What would change by what was said: how much, where, and whether it shall. */

import type { Opinion } from "../api/types.js";
import { countElsewhere, countOfPoints, kept, partOf, pointsOf } from "../data/opinion.js";
import type { LabelBook } from "../data/labels.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { keyButton } from "./buttons.js";

export function opinionBar({ store, actions }: Page): HTMLElement {
  const [what, which] = [h("b"), h("span", { class: "faint" })];
  const accept = keyButton("Accept", "Shift R", () => void actions.opine.askOrAccept());
  const next = keyButton("Next thing", "", () => void actions.opine.next());
  const leave = keyButton("Leave it out", "", () => actions.opine.leaveOut());
  const drop = keyButton("Drop", "Esc", () => actions.select.escape());
  const bar = h(
    "div",
    { class: "opinion-bar", role: "group", "aria-label": "What would change by what was said" },
    h("div", { class: "thing-words", role: "status" }, what, which),
    accept,
    next,
    leave,
    drop,
  );
  store.watch(
    ({ opinion, opinionAt, thinking, selection, cloud }) => [opinion, opinionAt, thinking, selection, cloud],
    (opinion, opinionAt, thinking) => {
      bar.hidden = opinion === null && !thinking;
      for (const one of [accept, next, drop]) one.hidden = opinion === null;
      leave.hidden = opinion?.changes[opinionAt] === undefined;
      say(what, opinion === null ? "Thinking over what was said…" : proposal(store.state, opinion));
      say(which, opinion === null ? "Go on meanwhile." : looked(opinion, opinionAt, store.state.labels));
    },
  );
  return bar;
}

/** What would change, as far as it's still wanted. */
function proposal({ cloud, selection, labels }: Readonly<State>, opinion: Opinion): string {
  const { changes } = selection.length === cloud.count ? kept(opinion, cloud, selection) : opinion;
  const become = (truth: "plausible" | "artifact"): number =>
    countOfPoints(pointsOf(changes.filter(({ label }) => labels.truth(label) === truth)));
  const [artifacts, plausible] = [counted(become("artifact"), "label"), become("plausible").toLocaleString("en")];
  const elsewhere = countElsewhere({ ...opinion, changes }, cloud);
  const beyond = elsewhere === 0 ? "" : `, ${elsewhere.toLocaleString("en")} of them not on screen`;
  return `${artifacts} would become artifact, ${plausible} plausible, in ${counted(changes.length, "thing")}${beyond}`;
}

function looked(opinion: Opinion, at: number, labels: LabelBook): string {
  const { answered, changes } = opinion;
  const change = changes[at];
  const said = `learned from ${counted(answered, "detection")}${partOf(opinion)}`;
  if (change === undefined) return `${said}; selected is what would change, Ctrl with a tool leaves some out`;
  const { label, probability, detections } = change;
  const count = `${countOfPoints(change.points).toLocaleString("en")} of its ${counted(detections, "detection")}`;
  const what = `${labels.choiceName(label)} (${Math.round(100 * probability)} %)`;
  return `${at + 1} of ${changes.length}: ${count} would be ${what}`;
}
