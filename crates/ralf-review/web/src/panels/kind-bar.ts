/** A question about many detections: what they have in common, what they are called, and the answers. */

import type { Kind, Sign } from "../api/kinds.js";
import { findScan } from "../data/cloud.js";
import { ARTIFACT, PLAUSIBLE } from "../data/labels.js";
import { lineAt, linesOf, within } from "../data/kinds.js";
import { countOfPoints, keptPoints, partOf } from "../data/opinion.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { keyButton } from "./buttons.js";

const SIGNS: Readonly<Record<Sign, string>> = {
  moves: "by their Doppler velocity they move",
  weak: "four in five detections of their scans are stronger",
  ground: "they lie no higher than the ground may",
  behind: "something tall stands in the radar's way to them",
  free: "most LiDAR scans look through the place",
  again: "scan after scan sees them again",
  rest: "neither of them nor beside them is anything conspicuous",
};

export function kindBar({ store, actions }: Page): HTMLElement {
  const [what, why] = [h("b"), h("span", { class: "faint" })];
  const line = h("input", {
    type: "range",
    class: "line",
    min: "0",
    title: "How many of them: first those that all evidence contradicts most ([ and ])",
    "aria-label": "How many of them",
    on: { input: () => actions.kind.draw(Number(line.value)) },
  });
  const bar = h(
    "div",
    { class: "kind-bar", role: "group", "aria-label": "A question about many detections" },
    h("div", { class: "thing-words", role: "status" }, what, why),
    h(
      "div",
      { class: "answers" },
      line,
      keyButton("Plausible", "P", () => actions.select.choose(PLAUSIBLE)),
      keyButton("Artifact", "A", () => actions.select.choose(ARTIFACT)),
      keyButton("Leave", "Shift G", () => void actions.kind.next()),
    ),
  );
  store.watch(
    ({ kind, selection, cloud }) => [kind, selection, cloud],
    (kind, selection, cloud) => {
      bar.hidden = kind === null;
      bar.dataset["kind"] = kind?.kind ?? "";
      if (kind === null || selection.length !== cloud.count) return;
      say(what, question(store.state, kind));
      say(why, reasons(kind));
      drawn(line, kind);
    },
  );
  return bar;
}

/** The line where it is now. */
function drawn(line: HTMLInputElement, { asked, detections }: Kind): void {
  const lines = linesOf(detections);
  line.max = String(lines.length - 1);
  line.value = String(lineAt(lines, asked));
  line.setAttribute("aria-valuetext", `${asked.toLocaleString("en")} of ${counted(detections, "detection")}`);
}

function question({ cloud, selection, labels }: Readonly<State>, kind: Kind): string {
  const points = keptPoints(within(kind), cloud, selection);
  const elsewhere = countOfPoints(points.filter((part) => findScan(cloud, part) < 0));
  const beyond = elsewhere === 0 ? "" : ` (${elsewhere.toLocaleString("en")} of them not on screen)`;
  const where = `${counted(countOfPoints(points), "detection")} in ${counted(points.length, "scan")}`;
  return `${where}${beyond} are called ${labels.name(kind.label)}: are they?`;
}

function reasons(kind: Kind): string {
  const { sign, detections, expected_errors: errors, left } = kind;
  const [all, some] = [detections, Math.round(errors)].map((count) => count.toLocaleString("en"));
  const wrong = `some ${some} of all ${all} expected to be wrong${partOf(kind)}`;
  return [SIGNS[sign], wrong, `${counted(left, "question")} after this`].join(" · ");
}
