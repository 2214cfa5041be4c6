/** The classes, with a field to search them. */

import type { LabelClass } from "../api/types.js";
import { searchClasses, UNLABELLED } from "../data/labels.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import { openWith } from "./dialog.js";

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
