/** What must not be overlooked: a server that is gone, a refused stroke, a message. */

import type { Progress, Recording } from "../api/types.js";
import { countOfPoints } from "../data/opinion.js";
import { h, say } from "../dom.js";
import { counted } from "../format.js";
import { givenUp, pointsOf } from "../history/outbox.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { keyButton } from "./buttons.js";

export function banner({ store, actions }: Page): HTMLElement {
  const text = h("span", { class: "banner-text" });
  const reload = keyButton("Load the page again", "", () => location.reload());
  const retry = keyButton("Try again", "", () => void actions.correct.retry());
  const which = h("span", {});
  const drop = keyButton(which, "", () => void actions.correct.dropWaiting(), "quiet");
  const bar = h("div", { class: "banner", role: "alert" }, text, reload, retry, drop);
  store.watch(
    ({ outbox, waiting, link, recording, progress }) => [outbox, waiting, link, recording, progress],
    () => {
      const { link, waiting } = store.state;
      const said = trouble(store.state);
      bar.hidden = said === null;
      bar.classList.toggle("quiet", link.kind === "fine" && waiting.length === 0);
      say(text, said ?? "");
      reload.hidden = link.kind !== "elsewhere";
      retry.hidden = waiting.length === 0 || link.kind === "elsewhere";
      const given = toDrop(store.state);
      drop.hidden = given === null;
      say(which, given ?? "");
    },
  );
  return bar;
}

/** Which stroke the button drops; `null`: none. */
export function toDrop({ outbox, waiting, labels }: Readonly<State>): string | null {
  const given = givenUp(outbox, waiting);
  if (given.length === 0) return null;
  const said = [...new Set(given.map(({ stroke }) => labels.choiceName(stroke.label)))].join(" and ");
  const detections = countOfPoints(pointsOf(given));
  const which = outbox.kind === "gone" ? "last" : "refused";
  return `Drop the ${which} stroke (${said}, ${counted(detections, "detection")})`;
}

/** What is wrong, if anything is. */
export function trouble({ outbox, waiting, link, recording, progress }: Readonly<State>): string | null {
  const unsaved = counted(waiting.length, "stroke");
  if (link.kind === "elsewhere") {
    const kept =
      waiting.length === 0 ? "" : ` ${unsaved} not saved; kept in this browser until theirs are served here again.`;
    const served = `Another recording or output is served here now (${link.message})`;
    return `${served}: nothing of this page is saved there.${kept}`;
  }
  if (outbox.kind === "refused") return `The server refused a stroke: ${outbox.message}`;
  if (link.kind === "broken") return link.message;
  if (outbox.kind !== "gone" && link.kind === "fine") return standing(recording, progress);
  const kept =
    waiting.length === 0
      ? "Nothing is unsaved."
      : `${unsaved} not saved; kept in this window and sent when it is back.`;
  return `The server does not answer. ${kept} Is ralf review still running?`;
}

/** What holds all the time. */
function standing({ read_only: reason }: Recording, { orphaned_scans: orphaned }: Progress): string | null {
  if (reason !== null) return `Read-only: nothing can be corrected here. ${reason}`;
  if (orphaned === 0) return null;
  const scans = counted(orphaned, "scan");
  return `Corrections of ${scans} belong to other detections than the recording holds now: kept, and not applied.`;
}

/** Over the picture, while every stroke sets a label at once. */
export function painting({ store, actions }: Page): HTMLElement {
  const pill = h("button", {
    class: "painting",
    type: "button",
    title: "End painting (Esc)",
    on: { click: () => actions.select.disarm() },
  });
  store.watch(
    ({ armed, labels }) => [armed, labels],
    (armed, labels) => {
      pill.hidden = armed === undefined;
      if (armed === undefined) return;
      const truth = armed === null ? "machine" : labels.truth(armed);
      pill.replaceChildren(
        h("span", { class: truth }, h("span", { class: "dot" })),
        `Painting ${labels.choiceName(armed)}: every stroke sets it`,
        h("kbd", {}, "Esc"),
      );
    },
  );
  return h("div", { class: "painting-place" }, pill);
}

const NOTICE_MS = 6000;

/** A message that goes by itself, or when it's clicked. */
export function notice({ store, actions }: Page): HTMLElement {
  const box = h("button", {
    class: "notice",
    type: "button",
    title: "Dismiss",
    on: { click: () => actions.view.dismissNotice() },
  });
  const live = h("div", { class: "notice-place", role: "status", "aria-live": "polite" }, box);
  let timer = 0;
  store.watch(
    ({ notice: now }) => [now],
    (now) => {
      box.hidden = now === null;
      say(box, now?.text ?? "");
      box.classList.toggle("problem", now?.kind === "problem");
      window.clearTimeout(timer);
      if (now?.kind === "told") timer = window.setTimeout(() => actions.view.dismissNotice(), NOTICE_MS);
    },
  );
  return live;
}
