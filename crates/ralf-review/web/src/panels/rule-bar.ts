/** A rule that sets something: what it would change, before it does. */

import { pointsByScan } from "../data/cloud.js";
import { countAlready } from "../data/rules.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import { countOf } from "../selection/mask.js";
import type { State } from "../state.js";
import { keyButton } from "./buttons.js";

export function ruleBar({ store, actions }: Page): HTMLElement {
  const [what, how] = [h("b"), h("span", { class: "faint" }, "Ctrl with a tool leaves some out")];
  const apply = keyButton("Apply", "", () => void actions.rule.apply());
  const drop = keyButton("Drop", "Esc", () => actions.select.escape());
  const words = h("div", { class: "thing-words", role: "status" }, what, how);
  const bar = h(
    "div",
    { class: "rule-bar", role: "group", "aria-label": "What the rule would change" },
    words,
    apply,
    drop,
  );
  store.watch(
    ({ rule, selection, cloud }) => [rule, selection, cloud],
    (rule, selection, cloud) => {
      bar.hidden = rule === null || selection.length !== cloud.count;
      if (!bar.hidden) say(what, proposal(store.state));
    },
  );
  return bar;
}

/** What the rule would make of what is selected. */
function proposal({ rule, selection, cloud, labels, recording }: Readonly<State>): string {
  const sets = rule?.sets ?? null;
  if (rule === null || sets === null) return "";
  const already = countAlready(cloud, selection, sets, recording.sayable_causes);
  const count = countOf(selection) - already;
  const scans = pointsByScan(cloud, selection).length;
  const label = labels.nameWith(sets.label, sets.cause);
  const others = already === 0 ? "" : `, ${already.toLocaleString("en")} are so already`;
  const where = `${counted(count, "detection")} in ${counted(scans, "scan")}`;
  return `${rule.name}: ${where} would become ${label}${others}`;
}
