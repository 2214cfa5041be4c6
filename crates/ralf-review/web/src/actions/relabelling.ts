/** Notices that somebody labelled again: the threshold, what flags decide and what is labelled are others then. */

import { complain, type World } from "./world.js";

export class Relabelling {
  /** By sequence: the run whose labels were on screen last. */
  private readonly runs = new Map<string, string>();

  constructor(private readonly world: World) {
    world.store.watch(
      ({ sequence, cloud }) => [sequence, cloud.scans[0]?.table.header.run],
      (sequence, run) => this.saw(sequence, run),
    );
  }

  /** Reads anew what holds for all scans. */
  async read(): Promise<void> {
    this.world.store.set({ recording: await this.world.api.recording() });
  }

  private saw(sequence: string, run: string | undefined): void {
    if (run === undefined) return;
    const before = this.runs.get(sequence);
    this.runs.set(sequence, run);
    if (before !== undefined && before !== run) this.read().catch((error: unknown) => complain(this.world, error));
  }
}
