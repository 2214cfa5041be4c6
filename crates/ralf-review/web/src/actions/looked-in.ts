/** The scans that something is looked at in: whoever puts others on screen doesn't look at it any more. */

import { scansOf } from "../data/cloud.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export class LookedIn {
  private scans = "";

  constructor(
    private readonly store: Store<State>,
    left: () => void,
  ) {
    store.watch(
      ({ cloud }) => [cloud],
      (cloud) => {
        if (scansOf(cloud) !== this.scans) left();
      },
    );
  }

  /** It is looked at in the scans that are on screen now. */
  here(): void {
    this.scans = scansOf(this.store.state.cloud);
  }
}
