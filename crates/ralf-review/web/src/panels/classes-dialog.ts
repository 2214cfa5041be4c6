/** The classes, with a field to search them. */

import type { LabelClass } from "../api/types.js";
import { searchClasses, UNLABELLED } from "../data/labels.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import { openWith } from "./dialog.js";

export function classesDialog(page: Page): HTMLDialogElement {
  const { store, actions } = page;
  const known = store.state.recording.classes.filter(({ id }) => id !== UNLABELLED);
  const list = new ClassList((entry) => {
    actions.view.dialog("none");
    actions.select.choose(entry.id);
  });
  const search = h("input", {
    type: "search",
    placeholder: "Search by name, cluster or number",
    "aria-label": "Search classes",
    on: {
      input: () => list.show(searchClasses(known, search.value)),
      keydown: (event) => {
        const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
        if (event.key === "Enter") list.choose();
        if (step === undefined) return;
        event.preventDefault();
        list.step(step);
      },
    },
  });
  const title = h("h2", {}, "Class");
  const dialog = h("dialog", { class: "classes", "aria-label": "Choose a class" }, title, search, list.element);
  openWith(page, dialog, "classes", () => {
    search.value = "";
    list.show(known);
    search.focus();
  });
  return dialog;
}

/** The classes that were found, one of them pointed at. */
class ClassList {
  readonly element = h("div", { class: "class-list", role: "listbox", "aria-label": "Classes" });
  private found: readonly LabelClass[] = [];
  private at = 0;

  constructor(private readonly chosen: (entry: LabelClass) => void) {}

  show(found: readonly LabelClass[]): void {
    [this.found, this.at] = [found, 0];
    this.draw();
  }

  step(by: number): void {
    this.at = Math.min(Math.max(this.at + by, 0), this.found.length - 1);
    this.draw();
  }

  choose(): void {
    const entry = this.found[this.at];
    if (entry !== undefined) this.chosen(entry);
  }

  private draw(): void {
    this.element.replaceChildren(...this.found.map((entry, i) => this.row(entry, i === this.at)));
    this.element.children[this.at]?.scrollIntoView({ block: "nearest" });
  }

  private row(entry: LabelClass, selected: boolean): HTMLElement {
    return h(
      "button",
      {
        class: `class-entry ${entry.plausible === false ? "artifact" : "plausible"}`,
        type: "button",
        role: "option",
        "aria-selected": String(selected),
        tabindex: "-1",
        on: { click: () => this.chosen(entry) },
      },
      h("span", { class: "dot" }),
      h("span", {}, entry.name),
      h("span", { class: "faint" }, entry.cluster ?? ""),
      h("span", { class: "faint number" }, String(entry.id)),
    );
  }
}
