/** Where two people said different things: looked at one after the other, and settled by taking a side. */

import type { Disagreement } from "../api/types.js";
import { maskOf } from "../data/cloud.js";
import type { Choice } from "../data/labels.js";
import { baseOf, keptPoints } from "../data/opinion.js";
import { keyOf, nextDisagreement } from "../data/team.js";
import { intersection } from "../selection/mask.js";
import type { Correcting } from "./correcting.js";
import type { Navigation } from "./navigation.js";
import { lookAt } from "./thinging.js";
import { complain, tell, type World } from "./world.js";

export class Settling {
  /** Those that were looked at since the sequence was opened. */
  private seen = new Set<string>();
  private moving = false;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly correcting: Correcting,
  ) {
    const { store } = world;
    store.watch(
      ({ sequence }) => [sequence],
      () => {
        this.seen = new Set();
        store.set({ disagreements: null, disputed: null });
      },
    );
    // Whoever looks at something else doesn't settle this one any more.
    store.watch(
      ({ current, thing, opinion }) => [current, thing, opinion],
      () => {
        if (!this.moving && store.state.disputed !== null) store.set({ disputed: null });
      },
    );
  }

  /** Who has done how much, how far people agree, and where they don't. */
  async open(): Promise<void> {
    const { store, api } = this.world;
    try {
      const [{ days }] = await Promise.all([api.people(), this.read()]);
      store.set({ workdays: days, dialog: "team" });
    } catch (error) {
      complain(this.world, error);
    }
  }

  /** To the next disagreement, those about plausibility first. */
  async next(): Promise<void> {
    const { store } = this.world;
    store.set({ dialog: "none" });
    if (store.state.recording.second !== null)
      return tell(this.world, "Who labels a second time sees nobody else's labels.");
    try {
      await this.read();
      const next = nextDisagreement(store.state.disagreements?.changes ?? [], this.seen);
      if (next !== null) return await this.show(next);
      store.set({ disputed: null });
      tell(this.world, "Nothing is left of this sequence that two people through with it said differently.");
    } catch (error) {
      complain(this.world, error);
    }
  }

  /** Takes the first's side or the second's, and goes on. */
  take(side: "first" | "second"): void {
    const { disputed } = this.world.store.state;
    if (disputed !== null) this.answer(disputed[side]);
  }

  /** Says what it is, whoever said so, and goes on. */
  answer(choice: Choice): void {
    void this.settle(choice).catch((error: unknown) => complain(this.world, error));
  }

  private async settle(choice: Choice): Promise<void> {
    const { store } = this.world;
    const { disputed, disagreements, cloud, selection } = store.state;
    if (disputed === null || disagreements === null) return;
    const points = keptPoints(disputed.points, cloud, selection);
    if (!(await this.correcting.settle(points, baseOf(disagreements, points), choice))) return;
    if (store.state.outbox.kind === "idle") await this.next();
  }

  private async read(): Promise<void> {
    const { store, api } = this.world;
    const { sequence, recording } = store.state;
    if (recording.second !== null) return;
    const disagreements = await api.disagreements(sequence);
    if (sequence === store.state.sequence) store.set({ disagreements });
  }

  private async show(disagreement: Disagreement): Promise<void> {
    const { store } = this.world;
    this.seen.add(keyOf(disagreement));
    this.moving = true;
    try {
      await this.navigation.wholeSequence(disagreement);
      const { cloud, eligible } = store.state;
      const selection = intersection(maskOf(cloud, disagreement.points), eligible);
      store.set({ thing: null, opinion: null, disputed: disagreement, selection, armed: undefined });
    } finally {
      this.moving = false;
    }
    lookAt(this.world, disagreement);
  }
}
