/**
 * What of a disagreement isn't settled with it. Whoever takes detections out of the selection means it; what the filter
 * hides is selected again once it is shown.
 */

import { maskOf } from "../data/cloud.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export class Sparing {
  /** 1 for each detection of it on screen, and for those that nobody spared. */
  private all: Uint8Array = new Uint8Array(0);
  private wanted: Uint8Array = new Uint8Array(0);
  private eligible: Uint8Array = new Uint8Array(0);

  constructor(private readonly store: Store<State>) {
    store.watch(
      ({ selection, eligible }) => [selection, eligible],
      (selection, eligible) => this.heed(selection, eligible),
    );
  }

  /** All that is on screen of the disagreement that is looked at is wanted; returns what of it can be selected. */
  begin(): Uint8Array {
    const { cloud, eligible, disputed } = this.store.state;
    this.all = maskOf(cloud, disputed?.points ?? []);
    this.wanted = this.all.slice();
    this.eligible = eligible;
    return this.selectable();
  }

  private heed(selection: Uint8Array, eligible: Uint8Array): void {
    if (this.store.state.disputed === null || selection.length !== this.all.length) return;
    if (eligible === this.eligible) {
      this.wanted = this.wanted.map((is, i) => (eligible[i] === 1 ? selection[i] & this.all[i] : is));
      return;
    }
    this.eligible = eligible;
    const selectable = this.selectable();
    this.store.set({ selection: selection.map((is, i) => (this.all[i] === 1 ? selectable[i] : is)) });
  }

  private selectable(): Uint8Array {
    return this.wanted.map((is, i) => is & this.eligible[i]);
  }
}
