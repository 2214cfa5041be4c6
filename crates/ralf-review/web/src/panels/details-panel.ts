/** Every number of the detection under the pointer; without one, of the one selected. */

import { type Cloud, columnOf, pointOf } from "../data/cloud.js";
import type { LabelBook } from "../data/labels.js";
import { h } from "../dom.js";
import { counted, decimal, degrees } from "../format.js";
import type { Page } from "../page.js";
import { countOf } from "../selection/mask.js";
import type { State } from "../state.js";

const BRANCHES = [
  ["w", "w"],
  ["w_opt", "optical"],
  ["w_lm", "LiDAR"],
  ["w_cm", "camera"],
  ["w_tr", "tracking"],
] as const;
const MISMATCHES = [
  ["d_lm", "d LiDAR"],
  ["d_cm", "d camera"],
  ["d_tr", "d tracking"],
] as const;
const TOLD_APART = new Set<string>([
  ...BRANCHES.map(([name]) => name),
  ...MISMATCHES.map(([name]) => name),
  "x",
  "y",
  "z",
  "range",
  "azimuth",
  "elevation",
  "flags",
  "machine",
  "label",
  "corrected",
  "cause",
]);
const UNITS: Readonly<Record<string, string>> = {
  doppler: " m/s",
  doppler_compensated: " m/s",
  rcs: " dBsm",
  power: " dB",
  snr: " dB",
};

export function detailsPanel({ store }: Page): HTMLElement {
  const body = h("div", { class: "details-body" });
  store.watch(
    ({ hover, cloud, selection }) => [hover, cloud, selection],
    (hover, cloud, selection) => {
      const selected = countOf(selection);
      const index = hover >= 0 ? hover : selected === 1 ? selection.indexOf(1) : -1;
      if (index < 0 || index >= cloud.count)
        body.replaceChildren(overview(cloud, selection, selected, store.state.labels));
      else body.replaceChildren(...about(store.state, cloud, index));
    },
  );
  return h("section", { class: "details", "aria-label": "Detection" }, body);
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
  const { labels, recording } = state;
  const value = (name: string): number => columnOf(cloud, index, name);
  const label = cloud.label[index];
  const corrected = cloud.corrected[index] === 1;
  const heading = h(
    "h2",
    { class: labels.truth(label) },
    h("span", { class: "dot" }),
    labels.name(label),
    h("span", { class: "faint" }, corrected ? "corrected" : "by machine"),
  );
  const id = h("p", { class: "faint number" }, `${scan.radar} ${scan.scan} · detection ${point}`);
  const further = [...scan.table.columns.keys()].filter((name) => !TOLD_APART.has(name));
  const cause = recording.causes === null ? [] : fact("cause", recording.causes[value("cause")] || "none");
  const facts = [
    ...(corrected ? fact("machine", labels.name(scan.machine[point])) : []),
    ...cause,
    ...fact("range", `${decimal(value("range"), 2)} m`),
    ...fact("azimuth", degrees(value("azimuth"))),
    ...fact("elevation", degrees(value("elevation"))),
    ...fact("x y z", ["x", "y", "z"].map((name) => decimal(value(name), 1)).join(" ")),
    ...further.flatMap((name) => fact(name, decimal(value(name), 2) + (UNITS[name] ?? ""))),
    ...MISMATCHES.flatMap(([name, text]) => fact(text, decimal(value(name), 2))),
  ];
  const flags = recording.flags.filter(({ bit }) => (value("flags") & bit) !== 0);
  return [
    heading,
    id,
    h("div", { class: "branches" }, ...BRANCHES.map(([name, text]) => branch(text, value(name), recording.threshold))),
    h("dl", { class: "facts" }, ...facts),
    h("div", { class: "row wrap" }, ...flags.map(({ name }) => h("span", { class: "reason" }, name))),
  ];
}

/** A plausibility as a bar, with a tick at the threshold. */
function branch(text: string, value: number, threshold: number): HTMLElement {
  const known = Number.isFinite(value);
  const fill = h("span", { class: known && value < threshold ? "fill artifact" : "fill plausible" });
  fill.style.setProperty("width", `${known ? 100 * value : 0}%`);
  const tick = h("span", { class: "tick" });
  tick.style.setProperty("left", `${100 * threshold}%`);
  return h(
    "div",
    { class: known ? "branch" : "branch absent" },
    h("span", {}, text),
    h("span", { class: "branch-bar" }, fill, tick),
    h("b", { class: "number" }, decimal(value, 2)),
  );
}

function fact(name: string, value: string): HTMLElement[] {
  return [h("dt", {}, name), h("dd", { class: "number" }, value)];
}
