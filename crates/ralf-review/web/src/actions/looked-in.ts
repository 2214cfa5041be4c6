/** The scans that something is looked at in: whoever puts others on screen doesn't look at it any more. */

import { scansOf } from "../data/cloud.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export class LookedIn {
  private scans = "";
  /** True while other scans are being fetched for what is looked at. */
  private moving = false;

  constructor(
    private readonly store: Store<State>,
    left: () => void,
  ) {
    store.watch(
      ({ cloud }) => [cloud],
      (cloud) => {
        if (!this.moving && scansOf(cloud) !== this.scans) left();
      },
    );
  }

  /** Puts other scans on screen for it, which is not leaving it. */
  async elsewhere(move: () => Promise<void>): Promise<void> {
    this.moving = true;
    await move().finally(() => (this.moving = false));
  }

  /** It is looked at in the scans that are on screen now. */
  here(): void {
    this.scans = scansOf(this.store.state.cloud);
  }
}
