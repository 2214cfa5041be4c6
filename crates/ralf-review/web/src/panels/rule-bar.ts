/** A rule that sets something: what it would change, before it does. */

import { countAlready } from "../data/rules.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import { countOf } from "../selection/mask.js";
import type { State } from "../state.js";

export function ruleBar({ store, actions }: Page): HTMLElement {
  const [what, how] = [h("b"), h("span", { class: "faint" }, "Ctrl with a tool leaves some out")];
  const apply = h(
    "button",
    { class: "button", type: "button", on: { click: () => void actions.rule.apply() } },
    "Apply",
  );
  const drop = h("button", { class: "button", type: "button", on: { click: () => actions.select.escape() } }, "Drop ");
  drop.append(h("kbd", {}, "Esc"));
  const words = h("div", { class: "thing-words", role: "status" }, what, how);
  const bar = h(
    "div",
    { class: "rule-bar", role: "group", "aria-label": "What the rule would change" },
    words,
    apply,
    drop,
  );
  store.watch(
    ({ rule, selection, cloud, thing, opinion }) => [rule, selection, cloud, thing, opinion],
    (rule, selection, cloud, thing, opinion) => {
      bar.hidden = rule === null || thing !== null || opinion !== null || selection.length !== cloud.count;
      if (!bar.hidden) say(what, proposal(store.state));
    },
  );
  return bar;
}

/** What the rule would make of what is selected. */
export function proposal({ rule, selection, cloud, labels, recording }: Readonly<State>): string {
  const sets = rule?.sets ?? null;
  if (rule === null || sets === null) return "";
  const already = countAlready(cloud, selection, sets, recording.sayable_causes);
  const count = countOf(selection) - already;
  const scans = new Set([...selection.keys()].filter((i) => selection[i] === 1).map((i) => cloud.scanOf[i]));
  const label = labels.name(sets.label) + (sets.cause === null ? "" : ` (${sets.cause})`);
  const others = already === 0 ? "" : `, ${already.toLocaleString("en")} are so already`;
  const where = `${counted(count, "detection")} in ${counted(scans.size, "scan")}`;
  return `${rule.name}: ${where} would become ${label}${others}`;
}
