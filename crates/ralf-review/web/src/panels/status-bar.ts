/** The last line: whether everything is saved, who works, how far one can go back, where the pointer is. */

import { h, say } from "../dom.js";
import { counted, decimal } from "../format.js";
import type { Page } from "../page.js";
import { countOf } from "../selection/mask.js";
import type { State } from "../state.js";

export function statusBar({ store, actions }: Page): HTMLElement {
  const saved = h("span", { class: "saved", role: "status", "aria-live": "polite" });
  const work = h("span", { class: "work" });
  const history = h("span", { class: "number" });
  const cursor = h("span", { class: "number cursor" });
  const frame = h("span", { class: "number faint frame", title: "JavaScript time of the last drawn frame" });
  const author = h("button", {
    class: "link",
    type: "button",
    title: "What you are called (change)",
    on: { click: () => actions.view.dialog("name") },
  });
  const announced = h("span", { class: "unseen", role: "status", "aria-live": "polite" });
  store.watch(
    ({ announced: text }) => [text],
    (text) => say(announced, text),
  );
  const help = h(
    "button",
    { class: "link", type: "button", on: { click: () => actions.view.dialog("help") } },
    "All keys ",
    h("kbd", {}, "?"),
  );
  store.watch(
    ({ name }) => [name],
    (name) => say(author, name),
  );
  store.watch(
    ({ outbox, waiting, busy, history: past, connected }) => [outbox, waiting, busy, past, connected],
    () => {
      const [text, look] = savedState(store.state);
      say(saved, text);
      saved.className = `saved ${look}`;
    },
  );
  store.watch(
    ({ history: past }) => [past],
    (past) => say(history, `undo ${past.undo_depth} · redo ${past.redo_depth}`),
  );
  store.watch(
    ({ selection, armed, tool }) => [selection, armed, tool],
    () => say(work, workText(store.state)),
  );
  store.watch(
    ({ cursor: place }) => [place],
    (place) => say(cursor, place === null ? "" : `x ${decimal(place[0], 1)} m  y ${decimal(place[1], 1)} m`),
  );
  store.watch(
    ({ frameTime }) => [frameTime],
    (time) => say(frame, `${decimal(time, 1)} ms/frame`),
  );
  return h("footer", { class: "status-bar" }, saved, author, history, work, announced, cursor, frame, help);
}

/** What the state of saving is, in a word; "saved" only when nothing waits. */
export function savedState({
  outbox,
  waiting,
  busy,
  connected,
  recording,
}: Readonly<State>): readonly [text: string, look: string] {
  if (recording.read_only !== null) return ["read-only", "pending"];
  if (outbox.kind === "conflict") return ["conflict", "alarm"];
  if (outbox.kind === "gone" || outbox.kind === "refused")
    return [`${counted(waiting.length, "stroke")} not saved`, "alarm"];
  if (outbox.kind === "saving" || busy) return ["saving…", "pending"];
  return connected ? ["saved", "fine"] : ["offline", "alarm"];
}

function workText({ selection, armed, labels, tool }: Readonly<State>): string {
  const selected = countOf(selection);
  if (selected > 0) return `${counted(selected, "detection")} selected`;
  if (armed !== undefined) return `Painting: every stroke sets ${labels.choiceName(armed)} (Esc ends it)`;
  return tool === "click" ? "Click selects, Shift adds, Ctrl takes away" : "Drag selects, Shift adds, Ctrl takes away";
}
