/** Undo and redo: of one's own steps, strokes and marks alike. */

import { sameScan } from "../data/scan.js";
import type { Adopting } from "./adopting.js";
import { askPatiently } from "./asking.js";
import type { Correcting } from "./correcting.js";
import type { Navigation } from "./navigation.js";
import { complain, readOnly, type World } from "./world.js";

export class Stepping {
  private turn: Promise<void> = Promise.resolve();

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly adopting: Adopting,
    private readonly correcting: Correcting,
  ) {}

  undo(): Promise<void> {
    return this.inTurn("undo");
  }

  redo(): Promise<void> {
    return this.inTurn("redo");
  }

  /** They wait for each other, so that a key may be pressed quickly. */
  private inTurn(what: "undo" | "redo"): Promise<void> {
    this.turn = this.turn.then(() => this.take(what)).catch((error: unknown) => complain(this.world, error));
    return this.turn;
  }

  private async take(what: "undo" | "redo"): Promise<void> {
    const { store, api } = this.world;
    const { sequence, history } = store.state;
    if (readOnly(this.world) || !this.correcting.free(what) || history[what] === null) return;
    store.set({ busy: true });
    try {
      const answer = await askPatiently((id) => api[what](sequence, id));
      store.set({ history: answer.history });
      await this.adopting.adopt(sequence, answer.scans);
      const elsewhere = answer.scans.every((scan) => !store.state.cloud.scans.some((other) => sameScan(other, scan)));
      if (elsewhere && answer.scans.length > 0) await this.navigation.goTo(answer.scans[0]);
    } catch (error) {
      await this.adopting.refused(what === "undo" ? "undone" : "redone", error);
    } finally {
      store.set({ busy: false });
    }
  }
}
