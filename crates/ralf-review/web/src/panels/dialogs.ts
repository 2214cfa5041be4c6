/** Every key; and the classes, with a field to search them. */

import type { LabelClass } from "../api/types.js";
import { searchClasses, UNLABELLED } from "../data/labels.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import type { Dialog } from "../state.js";
import { GROUPS, type Key, shownKey } from "./keys.js";

export function helpDialog({ store, actions }: Page, table: readonly Key[]): HTMLDialogElement {
  const groups = GROUPS.map((group) =>
    h(
      "section",
      {},
      h("h3", {}, group),
      ...table
        .filter((key) => key.group === group)
        .map((key) =>
          h(
            "div",
            { class: "key-row" },
            h(
              "span",
              { class: "keys" },
              ...key.keys.map((name) =>
                h("span", { class: "key-combination" }, ...shownKey(name).map((part) => h("kbd", {}, part))),
              ),
            ),
            h("span", {}, key.text),
          ),
        ),
    ),
  );
  const mouse = h(
    "section",
    {},
    h("h3", {}, "Mouse"),
    ...MOUSE.map(([what, text]) =>
      h("div", { class: "key-row" }, h("span", { class: "keys" }, h("kbd", {}, what)), h("span", {}, text)),
    ),
  );
  const close = h(
    "button",
    { class: "button", type: "button", on: { click: () => actions.view.dialog("none") } },
    "Close",
  );
  const dialog = h(
    "dialog",
    { class: "help", "aria-label": "Keys" },
    h("header", {}, h("h2", {}, "Keys and mouse"), close),
    h("div", { class: "help-columns" }, ...groups, mouse),
  );
  openWith({ store, actions }, dialog, "help");
  return dialog;
}

const MOUSE = [
  ["Left", "The tool; Shift adds to the selection, Ctrl takes away"],
  ["Right", "Moves the bird's eye; turns the free view (with Shift: moves)"],
  ["Middle", "Moves the view"],
  ["Wheel", "Nearer or farther, towards the pointer"],
  ["Double", "Closes a polygon"],
] as const;

export function classesDialog({ store, actions }: Page): HTMLDialogElement {
  const list = h("div", { class: "class-list", role: "listbox", "aria-label": "Classes" });
  const known = store.state.recording.classes.filter(({ id }) => id !== UNLABELLED);
  let found: readonly LabelClass[] = known;
  let at = 0;
  const choose = (entry: LabelClass | undefined): void => {
    if (entry === undefined) return;
    actions.view.dialog("none");
    actions.select.choose(entry.id);
  };
  const show = (): void => {
    list.replaceChildren(
      ...found.map((entry, i) =>
        h(
          "button",
          {
            class: `class-entry ${entry.plausible === false ? "artifact" : "plausible"}`,
            type: "button",
            role: "option",
            "aria-selected": String(i === at),
            tabindex: "-1",
            on: { click: () => choose(entry) },
          },
          h("span", { class: "dot" }),
          h("span", {}, entry.name),
          h("span", { class: "faint" }, entry.cluster ?? ""),
          h("span", { class: "faint number" }, String(entry.id)),
        ),
      ),
    );
    list.children[at]?.scrollIntoView({ block: "nearest" });
  };
  const search = h("input", {
    type: "search",
    placeholder: "Search by name, cluster or number",
    "aria-label": "Search classes",
    on: {
      input: () => {
        [found, at] = [searchClasses(known, search.value), 0];
        show();
      },
      keydown: (event) => {
        const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
        if (event.key === "Enter") choose(found[at]);
        if (step === undefined) return;
        event.preventDefault();
        at = Math.min(Math.max(at + step, 0), found.length - 1);
        show();
      },
    },
  });
  const dialog = h("dialog", { class: "classes", "aria-label": "Choose a class" }, h("h2", {}, "Class"), search, list);
  openWith({ store, actions }, dialog, "classes", () => {
    [search.value, found, at] = ["", known, 0];
    show();
    search.focus();
  });
  return dialog;
}

/** Opens and closes a dialog as the state says; Escape and a press outside close it. */
function openWith(
  { store, actions }: Page,
  dialog: HTMLDialogElement,
  name: Dialog,
  opened: () => void = () => undefined,
): void {
  const close = (): void => {
    if (store.state.dialog === name) actions.view.dialog("none");
  };
  dialog.addEventListener("cancel", close);
  dialog.addEventListener("close", close);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) close();
  });
  store.watch(
    ({ dialog: now }) => [now],
    (now) => {
      if (now === name && !dialog.open) {
        dialog.showModal();
        opened();
      } else if (now !== name && dialog.open) {
        dialog.close();
      }
    },
  );
}
