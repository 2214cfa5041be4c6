/** Somebody was faster: who, what and when; the stroke waits for a decision, and for a look at the newer state. */

import { h } from "../dom.js";
import { isShown, toldOf } from "../history/met.js";
import type { Page } from "../page.js";
import { keyButton } from "./buttons.js";

export function conflictDialog({ store, actions }: Page): HTMLElement {
  const body = h("div", { class: "conflict-body" });
  const spare = h("input", { type: "checkbox", id: "spare" });
  const spareLabel = h("label", { class: "check", for: "spare" }, spare, "Leave alone what is corrected already");
  const apply = keyButton("Apply my stroke to it", "", () => void actions.correct.applyAnyway(spare.checked));
  const goThere = async (): Promise<void> => {
    // The button is gone once what it shows is on screen.
    box.focus();
    await actions.correct.showMet();
  };
  const show = keyButton("Show it", "", () => void goThere(), "quiet");
  const drop = keyButton("Drop my stroke", "", () => void actions.correct.dropWaiting(), "quiet");
  const box = h(
    "section",
    { class: "conflict", role: "alertdialog", "aria-label": "Conflict", tabindex: "-1" },
    h("h2", {}, "Somebody changed this first"),
    body,
    show,
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
      // Not a button: a key that was on its way must not decide.
      box.focus();
    },
  );
  // What is on screen changes while somebody thinks it over.
  store.watch(
    ({ outbox, sequence, cloud, selection }) => [outbox, sequence, cloud, selection],
    (outbox) => {
      if (outbox.kind !== "conflict") return;
      const told = toldOf(outbox, store.state);
      body.replaceChildren(...told.map((text, at) => h("p", at < 2 ? {} : { class: "faint" }, text)));
      show.hidden = outbox.body.stale || isShown(outbox, store.state);
    },
  );
  return box;
}
