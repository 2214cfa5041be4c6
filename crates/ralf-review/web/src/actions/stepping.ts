/** Undo and redo: of one's own steps, strokes and marks alike. */

import type { BaseRevision, History, ScanCorrections } from "../api/types.js";
import type { Cloud } from "../data/cloud.js";
import { sameScan } from "../data/scan.js";
import type { Moved } from "../history/outbox.js";
import type { Adopting } from "./adopting.js";
import { askPatiently } from "./asking.js";
import type { Correcting } from "./correcting.js";
import type { Navigation } from "./navigation.js";
import { dismissProblem, readOnly, tell, type World } from "./world.js";

export class Stepping {
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

  /** They wait for each other and for strokes, so that a key may be pressed quickly. */
  private async inTurn(what: "undo" | "redo"): Promise<void> {
    if (readOnly(this.world)) return;
    const { sequence } = this.world.store.state;
    await this.correcting.inTurn(what, { sequence, base: [], run: () => this.take(what, sequence) });
  }

  private async take(what: "undo" | "redo", sequence: string): Promise<Moved | null> {
    const { store, api } = this.world;
    const { cloud } = store.state;
    const isHere = (): boolean => sequence === store.state.sequence;
    store.set({ busy: true });
    try {
      const answer = await askPatiently((id) => api[what](sequence, id));
      if (isHere()) store.set({ history: answer.history });
      dismissProblem(this.world);
      if (answer.changed === 0) tell(this.world, `Nothing is left to ${what} in sequence ${sequence}.`);
      await this.adopting.adopt(sequence, answer.scans);
      const elsewhere = answer.scans.every((scan) => !store.state.cloud.scans.some((other) => sameScan(other, scan)));
      if (isHere() && elsewhere && answer.scans.length > 0) await this.navigation.goTo(answer.scans[0]);
      // The other end of the history is what was just done: another window may have done more than was known here.
      const taken = answer.history[what === "undo" ? "redo" : "undo"];
      return isOfMarks(taken) ? null : { sequence, base: ownGround(cloud, answer.scans), scans: answer.scans };
    } catch (error) {
      await this.adopting.refused(sequence, what === "undo" ? "undone" : "redone", error);
      return null;
    } finally {
      store.set({ busy: false });
    }
  }
}

/** Marks leave revisions as they are. */
function isOfMarks(step: History["undo"]): boolean {
  return step !== null && (step.tool === "reviewed" || step.tool === "unreviewed");
}

/** The revisions on which a step was taken, of the scans in which nobody else came between. */
function ownGround({ scans }: Cloud, answered: readonly ScanCorrections[]): readonly BaseRevision[] {
  return answered.flatMap((answer) =>
    scans.some((scan) => sameScan(scan, answer) && scan.revision + 1 === answer.revision)
      ? [{ radar: answer.radar, scan: answer.scan, revision: answer.revision - 1 }]
      : [],
  );
}
