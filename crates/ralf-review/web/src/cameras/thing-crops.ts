/** What the cameras show of the thing that is looked at, cut out of their images: those that see most of it. */

import { countIn } from "../data/camera-moment.js";
import { maskOf } from "../data/cloud.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import { lookedAt, type State } from "../state.js";
import { CameraView } from "./camera-view.js";

const MOST = 2;

export function thingCrops(page: Page): HTMLElement {
  const views = Array.from({ length: MOST }, () => new CameraView(page));
  for (const { element } of views) element.classList.add("crop");
  const row = h("div", { class: "crops", role: "group", "aria-label": "The thing in the cameras" });
  row.append(...views.map(({ element }) => element));
  const { store } = page;
  store.watch(
    (state) => [state.cameras, lookedAt(state), state.selection],
    (cameras) => {
      const chosen = chosenOf(store.state);
      const seen = cameras
        .map((camera) => ({ camera, count: countIn(camera, chosen) }))
        .filter(({ count }) => count > 0)
        .sort((a, b) => b.count - a.count);
      row.hidden = seen.length === 0;
      views.forEach((view, i) => {
        view.element.hidden = i >= seen.length;
        view.show(seen[i]?.camera ?? null, chosen);
      });
    },
  );
  return row;
}

/** The detections of the thing that is looked at, 1 each. */
function chosenOf({ thing, disputed, opinion, opinionAt, cloud, selection }: Readonly<State>): Uint8Array {
  if (thing !== null) return selection;
  return maskOf(cloud, (disputed ?? opinion?.changes[opinionAt])?.points ?? []);
}
