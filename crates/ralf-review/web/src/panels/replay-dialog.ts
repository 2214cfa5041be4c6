/** What a rule would change in each sequence, and one press that makes it so. */

import type { ReplayPart } from "../data/replay.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import type { Replay } from "../state.js";
import { keyButton } from "./buttons.js";
import { openWith } from "./dialog.js";

export function replayDialog(page: Page): HTMLDialogElement {
  const { store, actions } = page;
  const [title, body] = [h("h2"), h("div", { class: "team-body" })];
  const apply = keyButton("Apply", "", () => void actions.replay.apply());
  const close = keyButton("Close", "", () => actions.view.dialog("none"), "quiet");
  const head = h("header", {}, title, h("div", { class: "row" }, apply, close));
  const dialog = h("dialog", { class: "help team replay", "aria-label": "A rule on all sequences" }, head, body);
  openWith(page, dialog, "replay");
  store.watch(
    ({ replay }) => [replay],
    (replay) => {
      if (replay === null) return;
      const { labels } = store.state;
      say(title, `${replay.name}: ${labels.nameWith(replay.sets.label, replay.sets.cause)}`);
      apply.disabled = replay.parts.length < replay.all || replay.parts.every(({ detections }) => detections === 0);
      body.replaceChildren(h("p", { role: "status" }, proposal(replay)), table(replay.parts));
    },
  );
  return dialog;
}

function proposal({ parts, all }: Replay): string {
  const detections = parts.reduce((sum, part) => sum + part.detections, 0);
  if (parts.length < all) return `Reading: ${parts.length} of ${counted(all, "sequence")}…`;
  const where = counted(parts.filter((part) => part.detections > 0).length, "sequence");
  return `${counted(detections, "label")} would change in ${where}, one stroke in each. What somebody corrected stays.`;
}

function table(parts: readonly ReplayPart[]): HTMLElement {
  const head = ["", "would change", "in scans", "so already", "corrected otherwise"];
  const cells = ({ sequence, detections, points, already, spared, problem }: ReplayPart): readonly HTMLElement[] => [
    h("th", { scope: "row" }, problem === null ? sequence : `${sequence}: ${problem}`),
    ...[detections, points.length, already, spared].map((count) =>
      h("td", { class: "number" }, problem === null ? count.toLocaleString("en") : "–"),
    ),
  ];
  return h(
    "table",
    {},
    h("thead", {}, h("tr", {}, ...head.map((text) => (text === "" ? h("td") : h("th", { scope: "col" }, text))))),
    h("tbody", {}, ...parts.map((part) => h("tr", {}, ...cells(part)))),
  );
}
