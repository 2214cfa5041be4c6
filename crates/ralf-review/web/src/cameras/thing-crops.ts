/** What the cameras show of a thing, cut out of their images: those that see most of it. */

import type { DoubtfulThing } from "../api/types.js";
import { countIn } from "../data/camera-moment.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { CameraView } from "./camera-view.js";

const MOST = 3;

/** `thing`: what is shown, if anything; `chosen`: its detections, 1 each. */
export function thingCrops(
  page: Page,
  thing: (state: Readonly<State>) => DoubtfulThing | null,
  chosen: (state: Readonly<State>) => Uint8Array,
): HTMLElement {
  const views = Array.from({ length: MOST }, () => new CameraView(page));
  for (const { element } of views) element.classList.add("crop");
  const row = h("div", { class: "crops", role: "group", "aria-label": "The thing in the cameras" });
  row.append(...views.map(({ element }) => element));
  const { store } = page;
  store.watch(
    (state) => [state.cameras, thing(state), state.selection],
    (cameras, shown) => {
      const mask = shown === null ? new Uint8Array(0) : chosen(store.state);
      const seen = cameras
        .map((camera) => ({ camera, count: countIn(camera, mask) }))
        .filter(({ count }) => count > 0)
        .sort((a, b) => b.count - a.count);
      row.hidden = seen.length === 0;
      views.forEach((view, i) => {
        view.element.hidden = i >= seen.length;
        view.show(seen[i]?.camera ?? null, mask);
      });
    },
  );
  return row;
}
