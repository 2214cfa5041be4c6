/** Marks of review. What nobody has looked at is not accepted by the way: it is counted first. */

import type { BaseRevision, ReviewedAnswer } from "../api/types.js";
import { withScans } from "../data/cloud.js";
import { sameScan, type Scan } from "../data/scan.js";
import { Sight } from "../data/sight.js";
import { withReviewed } from "../queue/queue.js";
import type { Adopting } from "./adopting.js";
import { askPatiently } from "./asking.js";
import type { Correcting } from "./correcting.js";
import type { Navigation } from "./navigation.js";
import type { Queueing } from "./queueing.js";
import { dismissProblem, readOnly, type World } from "./world.js";

export class Reviewing {
  private readonly sight = new Sight();

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly adopting: Adopting,
    private readonly correcting: Correcting,
    private readonly queueing: Queueing,
  ) {
    world.store.watch(
      ({ current }) => [current],
      () => {
        this.cancel();
        dismissProblem(world);
      },
    );
  }

  /** A picture was drawn: `places` are x, y of every detection, NaN where it isn't in it. */
  saw(places: Float32Array): void {
    const { cloud, shown, accepting } = this.world.store.state;
    this.sight.saw(cloud, shown, places);
    if (accepting !== null && this.sight.unseen(cloud, shown).all === 0) this.cancel();
  }

  /** Marks the scan, or takes the mark back. */
  toggle(): void {
    if (this.world.store.state.cloud.scans[0]?.reviewed === null) this.accept(false);
    else void this.mark(false);
  }

  /**
   * Marks the scan, and goes on to the next. Detections that were never on screen are counted first; a second time
   * accepts them.
   */
  accept(goOn: boolean): void {
    const { store } = this.world;
    const { cloud, shown, accepting, loading } = store.state;
    if (loading) return;
    const unseen = this.sight.unseen(cloud, shown);
    if (accepting === null && unseen.all > 0 && store.state.recording.read_only === null) {
      return store.set({ accepting: { ...unseen, goOn } });
    }
    this.cancel();
    const { current } = store.state;
    const isStill = (): boolean => sameScan(current, store.state.current);
    void this.mark(true).then((marked) => (marked && goOn && isStill() ? this.navigation.nextNeedy() : undefined));
  }

  cancel(): void {
    if (this.world.store.state.accepting !== null) this.world.store.set({ accepting: null });
  }

  /** Marks the scan on screen in its turn, wherever somebody has gone meanwhile. */
  private async mark(reviewed: boolean): Promise<boolean> {
    const { sequence, cloud, loading } = this.world.store.state;
    const seen = cloud.scans[0];
    // While another scan is coming, the one on screen isn't the one that is meant.
    if (seen === undefined || loading || readOnly(this.world)) return false;
    let marked = false;
    const { radar, scan, revision } = seen;
    const run = async ([now]: readonly BaseRevision[]): Promise<null> => {
      marked = await this.ask(sequence, { ...seen, revision: now.revision }, reviewed);
      return null;
    };
    await this.correcting.inTurn("mark", { sequence, base: [{ radar, scan, revision }], run });
    return marked;
  }

  private async ask(sequence: string, scan: Scan, reviewed: boolean): Promise<boolean> {
    const { store, api } = this.world;
    store.set({ busy: true });
    try {
      const { revision } = scan;
      const { stamp } = scan.table.header;
      const answer = await askPatiently((id) => api.reviewed(sequence, scan, { id, reviewed, revision, stamp }));
      dismissProblem(this.world);
      await this.adopt(sequence, scan, answer);
      return true;
    } catch (error) {
      await this.adopting.refused(sequence, "marked", error);
      return false;
    } finally {
      store.set({ busy: false });
    }
  }

  private async adopt(sequence: string, scan: Scan, answer: ReviewedAnswer): Promise<void> {
    const { store, loader } = this.world;
    loader.forget(sequence, scan);
    if (sequence !== store.state.sequence) return;
    const { cloud, scans } = store.state;
    const now = cloud.scans.find((other) => sameScan(other, scan));
    const marked = now === undefined ? [] : [{ ...now, reviewed: answer.reviewed }];
    for (const one of marked) loader.keep(sequence, one);
    store.set({
      cloud: withScans(cloud, marked),
      scans: withReviewed(scans, scan, answer.reviewed),
      progress: answer.progress,
      history: answer.history,
    });
    this.queueing.soon();
    // Without the mark the machine's labels count again, which may be others than those that were accepted.
    if (answer.reviewed === null) await this.adopting.reread(sequence, marked);
  }
}
