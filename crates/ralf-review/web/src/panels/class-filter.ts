/** Which classes are shown, and of which tellers. */

import { allSources, present, sourceName } from "../data/classes.js";
import type { Filter } from "../data/filter.js";
import { isClass } from "../data/labels.js";
import { childrenOf, h, pressed, say } from "../dom.js";
import type { Page } from "../page.js";
import { labelColour } from "../viewer/colours.js";
import { cssColour } from "../viewer/palette.js";
import { chip } from "./buttons.js";

type Asked = "classes" | "classFrom";

export function classFilter(page: Page): HTMLElement {
  const chosen = h("span", { class: "faint" });
  page.store.watch(
    ({ filter }) => [filter.classes.size + filter.classFrom.size],
    (count) => say(chosen, count === 0 ? "any" : `${count} chosen`),
  );
  const title = "Only detections of one of the chosen classes, told by one of the chosen";
  return h("details", {}, h("summary", { title }, "Classes ", chosen), classes(page), sources(page));
}

/** In place of a class where there is none on screen. */
const NONE = -1;

/** Those of the detections on screen, and those that are asked for. */
function classes(page: Page): HTMLElement {
  const row = h("div", { class: "row wrap", role: "group", "aria-label": "Only of these classes" });
  const { labels } = page.store.state;
  const put = childrenOf<number>(
    row,
    (id) => id,
    (id) => {
      if (id === NONE) return h("span", { class: "faint" }, "none on screen");
      const button = choice(page, "classes", id, labels.name(id), "swatched");
      button.style.setProperty("--colour", cssColour(labelColour(id, labels)));
      return button;
    },
    (button, id) => id !== NONE && pressed(button, page.store.state.filter.classes.has(id)),
  );
  page.store.watch(
    ({ cloud, filter }) => [cloud.label, filter.classes],
    (label, asked) => {
      const known = present([...label, ...asked]).filter(isClass);
      put(known.length > 0 ? known : [NONE]);
    },
  );
  return row;
}

function sources(page: Page): HTMLElement {
  const { recording } = page.store.state;
  const chips = allSources(recording).map((one) => {
    const button = choice(page, "classFrom", one, sourceName(one, recording), "flag");
    page.store.watch(
      ({ filter }) => [filter.classFrom],
      (asked) => pressed(button, asked.has(one)),
    );
    return button;
  });
  const label = h("span", { class: "faint" }, "told by");
  return h("div", { class: "row wrap tellers", role: "group", "aria-label": "Only where told by" }, label, ...chips);
}

function choice({ store, actions }: Page, asked: Asked, value: number, text: string, look: string): HTMLButtonElement {
  return chip(text, look, () => {
    const now = new Set(store.state.filter[asked]);
    if (!now.delete(value)) now.add(value);
    actions.view.filter({ [asked]: now } as Partial<Filter>);
  });
}
