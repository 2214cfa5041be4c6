/** The last line: whether everything is saved, who works, how far one can go back, where the pointer is. */

import { h, say } from "../dom.js";
import { counted, decimal } from "../format.js";
import type { Page } from "../page.js";
import type { Cloud } from "../data/cloud.js";
import type { LabelBook } from "../data/labels.js";
import { openers } from "./drawers.js";
import { countOf } from "../selection/mask.js";
import { isPress } from "../selection/tools.js";
import type { State } from "../state.js";

export function statusBar(page: Page): HTMLElement {
  const parts = [
    ...openers(page),
    saving(page),
    author(page),
    team(page),
    history(page),
    work(page),
    announced(page),
    cursor(page),
    frame(page),
  ];
  return h("footer", { class: "status-bar" }, ...parts, help(page));
}

function saving({ store }: Page): HTMLElement {
  const saved = h("span", { class: "saved", role: "status", "aria-live": "polite" });
  store.watch(
    ({ outbox, waiting, busy, history: past, link }) => [outbox, waiting, busy, past, link],
    () => {
      const [text, look] = savedState(store.state);
      say(saved, text);
      saved.className = `saved ${look}`;
    },
  );
  return saved;
}

function author({ store, actions }: Page): HTMLElement {
  const name = h("button", {
    class: "link",
    type: "button",
    title: "What you are called (change)",
    on: { click: () => actions.view.dialog("name") },
  });
  store.watch(
    ({ name: now }) => [now],
    (now) => say(name, now),
  );
  const { second } = store.state.recording;
  if (second === null) return name;
  const title = "They go to a file of your own, and nobody else's are shown";
  return h("span", { class: "second", title }, `second labels of ${second}`);
}

function team({ actions }: Page): HTMLElement {
  const title = "Who has done how much, and how far people agree (Shift T)";
  return h("button", { class: "link", type: "button", title, on: { click: () => void actions.settle.open() } }, "Team");
}

function history({ store }: Page): HTMLElement {
  const depths = h("span", { class: "number" });
  store.watch(
    ({ history: past }) => [past],
    (past) => say(depths, `undo ${past.undo_depth} · redo ${past.redo_depth}`),
  );
  return depths;
}

function work({ store }: Page): HTMLElement {
  const text = h("span", { class: "work" });
  store.watch(
    ({ selection, armed, tool, cloud }) => [selection, armed, tool, cloud],
    () => say(text, workText(store.state)),
  );
  return text;
}

/** For those who hear the page. */
function announced({ store }: Page): HTMLElement {
  const text = h("span", { class: "unseen", role: "status", "aria-live": "polite" });
  store.watch(
    ({ announced: now }) => [now],
    (now) => say(text, now),
  );
  return text;
}

function cursor({ store }: Page): HTMLElement {
  const place = h("span", { class: "number cursor" });
  store.watch(
    ({ cursor: at }) => [at],
    (at) => say(place, at === null ? "" : `x ${decimal(at[0], 1)} m  y ${decimal(at[1], 1)} m`),
  );
  return place;
}

function frame({ store }: Page): HTMLElement {
  const time = h("span", { class: "number faint frame", title: "From a change until the picture was painted" });
  store.watch(
    ({ frameTime }) => [frameTime],
    (now) => say(time, `${decimal(now, 1)} ms/frame`),
  );
  return time;
}

function help({ actions }: Page): HTMLElement {
  return h(
    "button",
    { class: "link", type: "button", on: { click: () => actions.view.dialog("help") } },
    "All keys ",
    h("kbd", {}, "?"),
  );
}

/** What the state of saving is, in a word; "saved" only when nothing waits. */
export function savedState({
  outbox,
  waiting,
  busy,
  link,
  recording,
}: Readonly<State>): readonly [text: string, look: string] {
  if (recording.read_only !== null) return ["read-only", "pending"];
  if (outbox.kind === "conflict") return ["conflict", "alarm"];
  if (outbox.kind === "gone" || outbox.kind === "refused")
    return [`${counted(waiting.length, "stroke")} not saved`, "alarm"];
  if (outbox.kind === "saving" || busy) return ["saving…", "pending"];
  if (link.kind === "fine") return ["saved", "fine"];
  return [link.kind === "gone" ? "offline" : "nothing is saved", "alarm"];
}

function workText({ selection, armed, labels, tool, cloud }: Readonly<State>): string {
  if (countOf(selection) > 0) return selectedText(selection, cloud, labels);
  if (armed !== undefined) return `Painting: every stroke sets ${labels.choiceName(armed)} (Esc ends it)`;
  return isPress(tool) ? "Click selects, Shift adds, Ctrl takes away" : "Drag selects, Shift adds, Ctrl takes away";
}

/** How much is selected, over how many scans, and how many of it say otherwise than most. */
export function selectedText(selection: Uint8Array, cloud: Cloud, labels: LabelBook): string {
  const scans = new Set<number>();
  let [selected, plausible] = [0, 0];
  selection.forEach((is, index) => {
    if (is === 0) return;
    selected += 1;
    scans.add(cloud.scanOf[index]);
    if (labels.truth(cloud.label[index]) === "plausible") plausible += 1;
  });
  const text = `${counted(selected, "detection")} selected`;
  if (scans.size < 2) return text;
  const otherwise = Math.min(plausible, selected - plausible);
  const most = 2 * plausible >= selected ? "plausible" : "artifact";
  return `${text} in ${scans.size} scans, most ${most}, ${otherwise.toLocaleString("en")} say otherwise`;
}
