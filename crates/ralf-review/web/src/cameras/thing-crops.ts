/** What the cameras show of the thing that is looked at, cut out of their images: those that see most of it. */

import type { ScanPoints } from "../api/types.js";
import { type Cloud, maskOf } from "../data/cloud.js";
import { h } from "../dom.js";
import type { Page } from "../page.js";
import { lookedAt, type State } from "../state.js";
import { CameraView } from "./camera-view.js";
import { Counting } from "./counting.js";

const MOST = 2;

export function thingCrops(page: Page): HTMLElement {
  const views = Array.from({ length: MOST }, () => new CameraView(page));
  for (const { element } of views) element.classList.add("crop");
  const row = h("div", { class: "crops", role: "group", "aria-label": "The thing in the cameras" });
  row.append(...views.map(({ element }) => element));
  const { store } = page;
  const [chosenIn, counting] = [chooser(), new Counting()];
  store.watch(
    (state) => [state.cameras, lookedAt(state), state.selection],
    (cameras) => {
      const chosen = chosenIn(store.state);
      const seen = cameras
        .map((camera) => ({ camera, count: counting.of(camera, chosen) }))
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

/** The detections of the thing that is looked at, 1 each: the same mask as long as they are the same. */
function chooser(): (state: Readonly<State>) => Uint8Array {
  let [points, starts]: [readonly ScanPoints[], Cloud["starts"]] = [NONE, []];
  let mask: Uint8Array = new Uint8Array(0);
  return ({ thing, disputed, opinion, opinionAt, cloud, selection }) => {
    if (thing !== null) return selection;
    const wanted = (disputed ?? opinion?.changes[opinionAt])?.points ?? NONE;
    if (wanted !== points || cloud.starts !== starts)
      [points, starts, mask] = [wanted, cloud.starts, maskOf(cloud, wanted)];
    return mask;
  };
}

const NONE: readonly ScanPoints[] = [];
