/** What the colours and rims mean. */

import { h } from "../dom.js";
import type { Page } from "../page.js";
import type { Legend } from "../viewer/colours.js";
import { colourModes } from "../viewer/colours.js";
import { CORRECTED_RGB, cssColour, type Rgb, SELECTED_RGB, UNCERTAIN_RGB, WAITING_RGB } from "../viewer/palette.js";

const RIMS: readonly (readonly [string, Rgb])[] = [
  ["uncertain", UNCERTAIN_RGB],
  ["corrected", CORRECTED_RGB],
  ["selected", SELECTED_RGB],
  ["not saved yet", WAITING_RGB],
];
const STEPS = 24;

export function legendPanel({ store }: Page): HTMLElement {
  const panel = h("div", { class: "legend", role: "group", "aria-label": "Legend" });
  store.watch(
    ({ painting, colour, waiting, cloud }) => [painting.legend, colour, waiting.length > 0, cloud.scans],
    (legend, colour, unsaved) => {
      const { cloud, recording } = store.state;
      const chosen = colourModes(cloud, recording).find(({ value }) => value === colour);
      const rims = h(
        "div",
        { class: "legend-rims" },
        ...RIMS.filter(([, rgb]) => unsaved || rgb !== WAITING_RGB).map(([name, rgb]) =>
          entry(name, rgb, rgb === WAITING_RGB ? "swatch rim broken" : "swatch rim"),
        ),
      );
      const title = h("b", { title: chosen?.meaning ?? "" }, chosen?.text ?? "Label");
      panel.replaceChildren(title, legend.kind === "scale" ? scale(legend) : entries(legend), rims);
    },
  );
  return panel;
}

function entries({ entries: list }: Extract<Legend, { kind: "categories" }>): HTMLElement {
  return h("div", { class: "legend-entries" }, ...list.map(([name, rgb]) => entry(name, rgb, "swatch")));
}

function entry(name: string, rgb: Rgb, look: string): HTMLElement {
  const swatch = h("span", { class: look });
  swatch.style.setProperty("--colour", cssColour(rgb));
  return h("span", { class: "legend-entry" }, swatch, name);
}

function scale({ least, most, unit, map }: Extract<Legend, { kind: "scale" }>): HTMLElement {
  const bar = h("span", { class: "legend-scale" });
  const stops = Array.from({ length: STEPS + 1 }, (_, step) => cssColour(map(step / STEPS)));
  bar.style.setProperty("background", `linear-gradient(to right, ${stops.join(", ")})`);
  const number = (value: number): string => `${Number(value.toFixed(2))}${unit === "" ? "" : ` ${unit}`}`;
  return h("div", { class: "legend-scale-row number" }, h("span", {}, number(least)), bar, h("span", {}, number(most)));
}
