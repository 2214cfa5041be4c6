/** The scans that something is looked at in: whoever puts others on screen doesn't look at it any more. */

import { scansOf } from "../data/cloud.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export class LookedIn {
  private scans = "";
  /** How often other scans are being fetched for what is looked at: somebody may go on before they are there. */
  private moves = 0;

  constructor(
    private readonly store: Store<State>,
    private readonly left: () => void,
  ) {
    store.watch(
      ({ cloud }) => [cloud],
      () => this.leaveIfElsewhere(),
    );
  }

  /** Whoever has put other scans on screen than it is looked at in has left it. */
  leaveIfElsewhere(): void {
    if (this.moves === 0 && scansOf(this.store.state.cloud) !== this.scans) this.left();
  }

  /** Puts other scans on screen for it, which is not leaving it. */
  async elsewhere(move: () => Promise<void>): Promise<void> {
    this.moves += 1;
    await move().finally(() => (this.moves -= 1));
  }

  /** It is looked at in the scans that are on screen now. */
  here(): void {
    this.scans = scansOf(this.store.state.cloud);
  }
}
