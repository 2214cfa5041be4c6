/** What the labels would be after what was said: asked for, looked at, and accepted as one step or dropped. */

import type { ProposedChange } from "../api/types.js";
import { maskOf } from "../data/cloud.js";
import { countOfPoints, kept, partOf, pointsOf } from "../data/opinion.js";
import { sameScan } from "../data/scan.js";
import { counted } from "../format.js";
import { countOf, intersection } from "../selection/mask.js";
import { isOnScreen, nothingChosen, NOTHING_LOOKED_AT } from "../state.js";
import type { Correcting } from "./correcting.js";
import { LookedIn } from "./looked-in.js";
import type { Navigation } from "./navigation.js";
import { lookAt } from "./thinging.js";
import { complain, tell, type World } from "./world.js";

export class Opining {
  private readonly lookedIn: LookedIn;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly correcting: Correcting,
  ) {
    world.store.watch(
      ({ sequence }) => [sequence],
      () => this.drop(),
    );
    this.lookedIn = new LookedIn(world.store, () => this.left());
  }

  /** Asks for it; what was asked for and is on screen is accepted. */
  async askOrAccept(): Promise<void> {
    const { opinion, thinking } = this.world.store.state;
    if (thinking) return;
    await (opinion === null ? this.ask() : this.accept()).catch((error: unknown) => complain(this.world, error));
  }

  /** Nothing of it is done. */
  drop(): void {
    this.world.store.set({ opinion: null, opinionAt: -1 });
  }

  /** To the next change of a thing, the largest first. */
  async next(): Promise<void> {
    const { opinion, opinionAt } = this.world.store.state;
    if (opinion === null || opinion.changes.length === 0) return;
    const at = (opinionAt + 1) % opinion.changes.length;
    this.world.store.set({ opinionAt: at });
    await this.show(opinion.changes[at]).catch((error: unknown) => complain(this.world, error));
  }

  /** Leaves the change that is looked at out, and goes to the one after it. */
  leaveOut(): void {
    const { store } = this.world;
    const { opinion, opinionAt, cloud, selection } = store.state;
    const change = opinion?.changes[opinionAt];
    if (opinion === null || change === undefined) return;
    const out = maskOf(cloud, change.points);
    const changes = opinion.changes.filter((other) => other !== change);
    store.set({
      opinion: { ...opinion, changes },
      opinionAt: opinionAt - 1,
      selection: selection.map((is, i) => is & (1 - out[i])),
    });
    void this.next();
  }

  private async ask(): Promise<void> {
    const { store, api } = this.world;
    if (store.state.current === null || !(await this.correcting.free("thinking it over"))) return;
    const { sequence, current, thinking } = store.state;
    if (thinking || current === null) return;
    store.set({ ...nothingChosen(store.state), thinking: true });
    try {
      const opinion = await api.opinion(sequence, store.state.cloud.scans[0]?.table.header.t_ns ?? "0");
      if (sequence !== store.state.sequence) return;
      if (opinion.answered === 0)
        return tell(this.world, `Correct or review something${partOf(opinion)} first: there is nothing to learn from.`);
      if (opinion.changes.length === 0)
        return tell(
          this.world,
          `Nothing else would change by what was said of ${counted(opinion.answered, "detection")}${partOf(opinion)}.`,
        );
      // Nobody's work is taken over: what was begun meanwhile comes first.
      const { thing, selection } = store.state;
      if (thing !== null || countOf(selection) > 0)
        return tell(this.world, "What would change is known, but you are at something: Shift+R shows it after that.");
      await this.navigation.wholeSequence(store.state.current ?? current);
      if (sequence !== store.state.sequence) return;
      store.set({ ...NOTHING_LOOKED_AT, opinion });
      this.select();
    } finally {
      store.set({ thinking: false });
    }
  }

  private async accept(): Promise<void> {
    const { store } = this.world;
    const { opinion, cloud, selection } = store.state;
    if (opinion === null) return;
    const accepted = kept(opinion, cloud, selection);
    if (!(await this.correcting.applyOpinion(accepted))) return;
    tell(this.world, `${counted(countOfPoints(pointsOf(accepted.changes)), "label")} changed; Ctrl+Z takes them back.`);
  }

  private async show(change: ProposedChange): Promise<void> {
    const { store } = this.world;
    const { opinion, cloud, selection, sequence } = store.state;
    if (opinion !== null && !cloud.scans.some((scan) => sameScan(scan, change))) {
      const still = kept(opinion, cloud, selection);
      const at = still.changes.findIndex(({ thing }) => thing === change.thing);
      store.set({ opinion: still, opinionAt: at });
      await this.lookedIn.elsewhere(() => this.navigation.wholeSequence(change));
      if (sequence !== store.state.sequence) return;
      // Somebody went on meanwhile, or elsewhere, or the scan can't be read.
      if (!isOnScreen(store.state, change)) return this.lookedIn.leaveIfElsewhere();
      this.select();
    }
    lookAt(this.world, change);
  }

  /** Whoever looks at other scans doesn't look at the proposal any more: what is left out of it would be lost. */
  private left(): void {
    if (this.world.store.state.opinion === null) return;
    this.drop();
    tell(this.world, "The proposal is dropped, for you look at something else: Shift+R asks again.");
  }

  /** Everything that would change and may be changed is selected. */
  private select(): void {
    const { store } = this.world;
    const { opinion, cloud, eligible } = store.state;
    if (opinion === null) return;
    this.lookedIn.here();
    store.set({ selection: intersection(maskOf(cloud, pointsOf(opinion.changes)), eligible) });
  }
}
