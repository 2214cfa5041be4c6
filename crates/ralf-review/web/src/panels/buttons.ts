/** Buttons as all bars have them. */

import { h } from "../dom.js";
import { icon, type IconName } from "../icons.js";

/** A button with a picture; `look` is what it is beside a tool. */
export function iconButton(name: IconName, title: string, run: () => void, look = ""): HTMLButtonElement {
  const attributes = { class: `tool ${look}`.trim(), type: "button", title, "aria-label": title };
  return h("button", { ...attributes, on: { click: run } }, icon(name));
}

/** A small choice that is made or isn't; `look` says what its dot looks like. */
export function chip(text: string, look: string, run: () => void): HTMLButtonElement {
  const attributes = { class: `chip small ${look}`, type: "button" };
  return h("button", { ...attributes, on: { click: run } }, h("span", { class: "dot" }), text);
}

/** A button with words, and the key that does the same where there is one. */
export function keyButton(text: HTMLElement | string, key: string, run: () => void, look = ""): HTMLButtonElement {
  const shown = key === "" ? [] : [" ", h("kbd", {}, key)];
  return h("button", { class: `button ${look}`.trim(), type: "button", on: { click: run } }, text, ...shown);
}

/** A button with words, and more of them in its title. */
export function textButton(look: string, title: string, text: string, run: () => void): HTMLButtonElement {
  return h("button", { class: look, type: "button", title, on: { click: run } }, text);
}
