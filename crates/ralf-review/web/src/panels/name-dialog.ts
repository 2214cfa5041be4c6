/** What the person in this browser is called. */

import { h } from "../dom.js";
import type { Page } from "../page.js";
import { openWith } from "./dialog.js";

export function nameDialog(page: Page): HTMLDialogElement {
  const { store, actions } = page;
  const name = h("input", { type: "text", "aria-label": "Your name", maxlength: "64" });
  // Whoever works here with others is one of those who were named.
  const { people } = store.state.recording;
  const known = h("datalist", { id: "people" }, ...people.map((value) => h("option", { value })));
  name.setAttribute("list", "people");
  const save = h("button", { class: "button", type: "submit" }, "Save");
  const form = h("form", { method: "dialog" }, h("h2", {}, "Your name"), name, known, save);
  form.addEventListener("submit", () => {
    actions.view.rename(name.value);
    // The browser tells of the closing with its next picture alone; keys count at once.
    actions.view.dialog("none");
  });
  const note =
    "Others see it beside what you correct. Undo takes back what was done in this browser, whatever it is called. " +
    "Another name is also that of everything that was done in this browser before: where several people share a " +
    "computer, each needs a browser profile of its own.";
  const dialog = h("dialog", { class: "name", "aria-label": "Your name" }, form, h("p", { class: "faint" }, note));
  openWith(page, dialog, "name", () => {
    name.value = store.state.name;
    name.select();
  });
  return dialog;
}
