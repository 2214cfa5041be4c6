/** Every number of the detection under the pointer; without one, of the one selected. */

import type { ColumnGroup } from "../api/table.js";
import type { Past, Recording, Saying } from "../api/types.js";
import { sourceName, UNTOLD } from "../data/classes.js";
import { type Cloud, columnOf, columnsOf, type NumberColumn, pointOf } from "../data/cloud.js";
import type { LabelBook } from "../data/labels.js";
import { isAccepted } from "../data/scan.js";
import { isMark, withMarksTogether } from "../data/team.js";
import { h } from "../dom.js";
import { clock, counted, decimal } from "../format.js";
import type { Page } from "../page.js";
import { fact, numbersOf } from "./facts.js";
import { countOf } from "../selection/mask.js";
import type { State } from "../state.js";

export function detailsPanel({ store }: Page): HTMLElement {
  const body = h("div", { class: "details-body" });
  store.watch(
    ({ hover, cloud, selection, past, recording }) => [hover, cloud, selection, past, recording],
    (hover, cloud, selection, past) => {
      const selected = countOf(selection);
      const index = hover >= 0 ? hover : selected === 1 ? selection.indexOf(1) : -1;
      if (index < 0 || index >= cloud.count)
        body.replaceChildren(overview(cloud, selection, selected, store.state.labels), ...recalled(store.state, past));
      else
        body.replaceChildren(...about(store.state, cloud, index), ...(hover >= 0 ? [] : recalled(store.state, past)));
    },
  );
  return h("section", { class: "details", "aria-label": "Detection", tabindex: "0" }, body);
}

function overview(cloud: Cloud, selection: Uint8Array, selected: number, labels: LabelBook): HTMLElement {
  const mask = selected > 0 ? selection : null;
  const counts = new Map<string, number>();
  for (let i = 0; i < cloud.count; i++) {
    if (mask === null ? cloud.scanOf[i] !== 0 : mask[i] === 0) continue;
    const name = labels.name(cloud.label[i]);
    counts.set(name, (counts.get(name) ?? 0) + 1);
  }
  const title = selected > 0 ? `${counted(selected, "detection")} selected` : "This scan";
  const rows = [...counts].sort((a, b) => b[1] - a[1]).map(([name, count]) => fact(name, count.toLocaleString("en")));
  const hint =
    selected > 0 ? "P plausible · A artifact · C class · M machine" : "Point at a detection to see its numbers.";
  return h(
    "div",
    {},
    h("h2", {}, title),
    h("dl", { class: "facts" }, ...rows.flat()),
    h("p", { class: "faint" }, hint),
  );
}

function about(state: Readonly<State>, cloud: Cloud, index: number): HTMLElement[] {
  const { scan, point } = pointOf(cloud, index);
  const columns = columnsOf(cloud).filter(({ name }) => scan.table.columns.has(name));
  const of = (group: ColumnGroup): readonly NumberColumn[] => columns.filter((column) => column.group === group);
  const value = (name: string): number => columnOf(cloud, index, name);
  const { recording, labels } = state;
  const flags = recording.flags.filter(({ bit }) => (value("flags") & bit) !== 0);
  const numbers = [...of("place"), ...of("measured"), ...of("mismatch")];
  const id = h("p", { class: "faint number" }, `${scan.radar} ${scan.scan} · detection ${point}`);
  return [
    heading(cloud, index, labels),
    id,
    h("div", { class: "row wrap" }, ...flags.map(({ name }) => h("span", { class: "reason" }, name))),
    h(
      "div",
      { class: "branches" },
      ...byName(of("plausibility")).map((column) => branch(column, value(column.name), recording.threshold)),
    ),
    h("dl", { class: "facts words" }, ...said(state, cloud, index)),
    ...numbersOf(numbers, value),
  ];
}

function heading(cloud: Cloud, index: number, labels: LabelBook): HTMLElement {
  const label = cloud.label[index];
  return h(
    "h2",
    { class: labels.truth(label) },
    h("span", { class: "dot" }),
    labels.name(label),
    h("span", { class: "faint" }, sayer(cloud, index)),
  );
}

/** Who says what the label is. */
export function sayer(cloud: Cloud, index: number): string {
  const { scan, point } = pointOf(cloud, index);
  if (cloud.corrected[index] === 1) return "corrected";
  return isAccepted(scan, point) ? `accepted by ${scan.reviewed?.author ?? "somebody"}` : "by machine";
}

/** What the machine said where a person said otherwise, who tells the class, and the cause where it is known. */
function said({ labels, recording }: Readonly<State>, cloud: Cloud, index: number): HTMLElement[] {
  const { scan, point } = pointOf(cloud, index);
  const named = labels.nameWith(scan.machine[point], tellerOf(scan.classFrom[point], recording));
  const machine = sayer(cloud, index) === "by machine" ? [] : fact("machine", named);
  const teller = tellerOf(cloud.classFrom[index], recording);
  const from = teller === null ? [] : fact("class from", teller, "what tells the class");
  const { causes } = recording;
  const truth = causes === null ? [] : fact("true cause", causes[columnOf(cloud, index, "cause")] || "none");
  const guess = scan.table.header.machine_causes?.[columnOf(cloud, index, "machine_cause")] ?? "";
  const cause = guess === "" ? truth : [...truth, ...fact("cause by machine", guess)];
  const why = recording.sayable_causes[cloud.saidCause[index]] ?? "";
  return [...machine, ...from, ...cause, ...(why === "" ? [] : fact("cause said", why))];
}

function tellerOf(source: number, recording: Recording): string | null {
  return source === UNTOLD ? null : sourceName(source, recording);
}

/** Who said what, and when; the last first. */
function recalled({ labels }: Readonly<State>, past: Past | null): HTMLElement[] {
  if (past === null || past.said.length === 0) return [];
  const why = ({ cause }: Saying): string => (cause === null ? "" : `, ${cause}`);
  const what = (saying: Saying): string =>
    isMark(saying) ? saying.tool : `${labels.choiceName(saying.label)}${why(saying)} (${saying.tool})`;
  const rows = withMarksTogether(past.said).map((saying) => {
    const of = past.detections === 1 ? "" : ` · ${saying.detections} of ${past.detections}`;
    const gone = saying.holds ? "" : " · taken back";
    return h(
      "li",
      { class: saying.holds ? "saying" : "saying gone" },
      h("span", {}, h("b", {}, saying.author), ` ${what(saying)}`),
      h("span", { class: "faint" }, `${clock(saying.at)}${of}${gone}`),
    );
  });
  const title = past.detections === 1 ? "What was said of it" : "What was said of the thing";
  return [h("h3", {}, title), h("ul", { class: "past" }, ...rows)];
}

/** The fused plausibility (the shortest name) first. */
function byName(columns: readonly NumberColumn[]): readonly NumberColumn[] {
  return [...columns].sort((a, b) => a.name.length - b.name.length);
}

/** A plausibility as a bar, with a tick at the threshold. */
function branch({ name, meaning }: NumberColumn, value: number, threshold: number): HTMLElement {
  const known = Number.isFinite(value);
  const fill = h("span", { class: known && value < threshold ? "fill artifact" : "fill plausible" });
  fill.style.setProperty("width", `${known ? 100 * value : 0}%`);
  const tick = h("span", { class: "tick" });
  tick.style.setProperty("left", `${100 * threshold}%`);
  return h(
    "div",
    { class: known ? "branch" : "branch absent", title: meaning },
    h("span", {}, name),
    h("span", { class: "branch-bar" }, fill, tick),
    h("b", { class: "number" }, decimal(value, 2)),
  );
}
