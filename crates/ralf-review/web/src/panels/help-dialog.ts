/** Every key, and what the mouse does. */

import { h } from "../dom.js";
import type { Page } from "../page.js";
import { openWith } from "./dialog.js";
import { GROUPS, type Key, shownKey } from "./keys.js";

export function helpDialog({ store, actions }: Page, table: readonly Key[]): HTMLDialogElement {
  const groups = GROUPS.map((group) => section(group, table.filter((key) => key.group === group).map(keyRow)));
  const mouse = section(
    "Mouse",
    MOUSE.map(([what, text]) => row([h("kbd", {}, what)], text)),
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

function section(title: string, rows: readonly HTMLElement[]): HTMLElement {
  return h("section", {}, h("h3", {}, title), ...rows);
}

function keyRow({ keys, text }: Key): HTMLElement {
  const combination = (name: string): HTMLElement =>
    h("span", { class: "key-combination" }, ...shownKey(name).map((part) => h("kbd", {}, part)));
  return row(keys.map(combination), text);
}

function row(keys: readonly HTMLElement[], text: string): HTMLElement {
  return h("div", { class: "key-row" }, h("span", { class: "keys" }, ...keys), h("span", {}, text));
}

const MOUSE = [
  ["Left", "The tool; Shift adds to the selection, Ctrl takes away"],
  ["Right", "Moves the bird's eye; turns the free view (with Shift: moves)"],
  ["Middle", "Moves the view"],
  ["Wheel", "Nearer or farther, towards the pointer"],
  ["Double", "Closes a polygon"],
] as const;
