/** What stands beside the picture is laid over it in a small window, when it is asked for. */

import { h } from "../dom.js";
import type { Page } from "../page.js";
import type { Drawer } from "../state.js";

const DRAWERS: readonly (readonly [Exclude<Drawer, "none">, string, string])[] = [
  ["scans", "Scans", "The list of scans, and which detections are shown"],
  ["numbers", "Numbers", "The cameras, and the numbers of the detection under the pointer"],
];

/** The buttons that open them; a window with room for both shows none. */
export function openers({ store, actions }: Page): readonly HTMLElement[] {
  return DRAWERS.map(([name, text, title]) => {
    const attributes = { class: `opener ${name}`, type: "button", title, "aria-controls": name };
    const button = h("button", { ...attributes, on: { click: () => actions.view.drawer(name) } }, text);
    store.watch(
      ({ drawer }) => [drawer],
      (drawer) => button.setAttribute("aria-expanded", String(drawer === name)),
    );
    return button;
  });
}

/** Tells styles which one is open. */
export function drawn({ store }: Page, layout: HTMLElement): HTMLElement {
  store.watch(
    ({ drawer }) => [drawer],
    (drawer) => layout.setAttribute("data-drawer", drawer),
  );
  return layout;
}
