/**
 * Somebody was faster: who, what and when; the newer state is on screen already, and the stroke waits for a
 * decision.
 */

import { sameScan } from "../data/scan.js";
import { h } from "../dom.js";
import { clock, counted } from "../format.js";
import type { OutboxStatus } from "../history/outbox.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { keyButton } from "./buttons.js";

type Met = Extract<OutboxStatus, { kind: "conflict" }>;

export function conflictDialog({ store, actions }: Page): HTMLElement {
  const body = h("div", { class: "conflict-body" });
  const spare = h("input", { type: "checkbox", id: "spare" });
  const spareLabel = h("label", { class: "check", for: "spare" }, spare, "Leave alone what is corrected already");
  const apply = keyButton("Apply my stroke to it", "", () => void actions.correct.applyAnyway(spare.checked));
  const drop = keyButton("Drop my stroke", "", () => void actions.correct.dropWaiting(), "quiet");
  const box = h(
    "section",
    { class: "conflict", role: "alertdialog", "aria-label": "Conflict", tabindex: "-1" },
    h("h2", {}, "Somebody changed this first"),
    body,
    spareLabel,
    h("div", { class: "row" }, apply, drop),
  );
  store.watch(
    ({ outbox }) => [outbox],
    (outbox) => {
      const met = outbox.kind === "conflict" ? outbox : null;
      box.hidden = met === null;
      if (met === null) return;
      spare.checked = met.pending.stroke.protect;
      // A stroke on detections that aren't there any more can only be dropped.
      apply.hidden = met.body.stale;
      spareLabel.hidden = met.body.stale;
      body.replaceChildren(...told(met, store.state));
      // Not a button: a key that was on its way must not decide.
      box.focus();
    },
  );
  return box;
}

function told({ body, pending }: Met, { labels, name }: Readonly<State>): HTMLElement[] {
  const { stroke } = pending;
  const count = stroke.points.reduce((sum, { points }) => sum + points.length, 0);
  const touched = stroke.points.reduce((sum, { radar, scan, points }) => {
    const now = new Set(
      body.scans.find((other) => sameScan(other, { radar, scan }))?.corrections.map(([point]) => point),
    );
    return sum + points.filter((point) => now.has(point)).length;
  }, 0);
  const { conflict } = body;
  const elsewhere = conflict?.author === name ? " (in another window)" : "";
  const who =
    conflict === null
      ? body.error
      : `${conflict.author}${elsewhere} changed ${conflict.radar} ${conflict.scan} with ${conflict.tool}, ` +
        `${clock(conflict.at)}.`;
  if (body.stale)
    return [h("p", {}, who), h("p", {}, "Your stroke was made on what was there before. Nothing of it is saved.")];
  const wanted = `${counted(count, "detection")} to ${labels.choiceName(stroke.label)}`;
  const corrected = `${touched === 0 ? "none" : touched} of them ${touched === 1 ? "is" : "are"} corrected there`;
  return [
    h("p", {}, who),
    h("p", {}, `Your ${stroke.tool} sets ${wanted}. Nothing of it is saved yet.`),
    h("p", { class: "faint" }, `The picture shows the newer state, with your detections selected; ${corrected}.`),
  ];
}
