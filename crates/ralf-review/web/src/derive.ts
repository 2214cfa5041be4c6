/** What follows from the rest of the state: what is shown, what may be changed, and the colours. */

import { inAreas } from "./data/area.js";
import { certaintyOf, visible } from "./data/filter.js";
import { intersection } from "./selection/mask.js";
import { homeOf, type State } from "./state.js";
import type { Store } from "./store.js";
import { paint } from "./viewer/colours.js";

export function deriveAlways(store: Store<State>): void {
  store.watch(
    ({ cloud, filter, scope, recording }) => [cloud, filter, scope, recording],
    (cloud, filter, scope, recording) => {
      const { labels, selection } = store.state;
      const passed = visible(cloud, filter, labels, certaintyOf(recording));
      const shown = intersection(passed, inAreas(cloud, filter.areas, homeOf(store.state), labels));
      const eligible = scope === "shown" ? shown : shown.map((value, i) => value & Number(cloud.scanOf[i] === 0));
      const same = selection.length === cloud.count;
      store.set({ shown, eligible, selection: same ? intersection(selection, eligible) : new Uint8Array(cloud.count) });
    },
  );
  store.watch(
    ({ cloud, colour, recording }) => [cloud, colour, recording],
    (cloud, colour, recording) => {
      const { labels } = store.state;
      store.set({ painting: paint(cloud, colour, labels, recording) });
    },
  );
}
