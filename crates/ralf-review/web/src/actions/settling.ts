/** Where two people said different things: looked at one after the other, and settled by taking a side. */

import type { BaseRevision, Disagreement } from "../api/types.js";
import { everything } from "../data/filter.js";
import type { Choice } from "../data/labels.js";
import { countOfPoints, keptPoints } from "../data/opinion.js";
import { keyOf, nextDisagreement, outlookOf } from "../data/team.js";
import { counted } from "../format.js";
import { isOnScreen, nothingChosen, NOTHING_LOOKED_AT } from "../state.js";
import type { Correcting } from "./correcting.js";
import { LookedIn } from "./looked-in.js";
import type { Navigation } from "./navigation.js";
import { Sparing } from "./sparing.js";
import { lookAt } from "./thinging.js";
import { complain, tell, type World } from "./world.js";

export class Settling {
  /** Those that were looked at since the sequence was opened. */
  private seen = new Set<string>();
  /** What was said when the one on screen was read: whatever is said since is a conflict. */
  private base: readonly BaseRevision[] = [];
  private readonly lookedIn: LookedIn;
  private readonly sparing: Sparing;

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
    // Whoever goes to another scan doesn't settle this one any more.
    store.watch(
      ({ current }) => [current],
      () => this.drop(),
    );
    this.lookedIn = new LookedIn(store, () => this.left());
    this.sparing = new Sparing(store);
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

  /** Takes the first's side or the second's, with the cause that was said, and goes on. */
  take(side: "first" | "second"): void {
    const { disputed } = this.world.store.state;
    if (disputed !== null) this.answer(disputed[side], disputed[`${side}_cause`]);
  }

  /** Says what it is, whoever said so, and goes on. */
  answer(choice: Choice, cause: string | null = null): void {
    void this.settle(choice, cause).catch((error: unknown) => complain(this.world, error));
  }

  /** Shows all of the disagreement, and lets all of it be settled. */
  showAll(): void {
    this.world.store.set({ filter: everything, scope: "shown" });
  }

  private async settle(choice: Choice, cause: string | null): Promise<void> {
    const { store } = this.world;
    const { disputed, cloud, selection } = store.state;
    if (disputed === null) return;
    const points = keptPoints(disputed.points, cloud, selection);
    const { unshown, unreached } = outlookOf(disputed, store.state);
    if (points.length === 0)
      return tell(
        this.world,
        "None of these is selected, so nothing is settled: they are spared, or the filter hides them.",
      );
    if (!(await this.correcting.settle(points, this.base, choice, cause))) return;
    const left = unshown + unreached;
    if (left > 0)
      tell(this.world, `${counted(countOfPoints(points), "detection")} settled; ${left} that were hidden are left.`);
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
    const { sequence } = store.state;
    this.seen.add(keyOf(disagreement));
    const base = store.state.disagreements?.base ?? [];
    store.set(nothingChosen(store.state));
    await this.navigation.wholeSequence(disagreement);
    // Somebody went elsewhere meanwhile, or the scan can't be read.
    if (sequence !== store.state.sequence || !isOnScreen(store.state, disagreement)) return;
    this.lookedIn.here();
    this.base = base;
    store.set({ ...NOTHING_LOOKED_AT, disputed: disagreement, armed: undefined });
    store.set({ selection: this.sparing.begin() });
    lookAt(this.world, disagreement);
  }

  /** Whoever looks at other scans doesn't see any more what is spared, and what isn't. */
  private left(): void {
    if (this.world.store.state.disputed === null) return;
    this.drop();
    tell(this.world, "The disagreement is left, for you look at something else: Shift+S goes on.");
  }

  private drop(): void {
    if (this.world.store.state.disputed !== null) this.world.store.set({ disputed: null });
  }
}
