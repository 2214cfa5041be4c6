/** Takes over what the server says of scans. */

import { Conflict } from "../api/errors.js";
import type { ScanCorrections } from "../api/types.js";
import { holdsStill, withScans } from "../data/cloud.js";
import { sameScan, type Scan, withCorrections } from "../data/scan.js";
import { progressOf, withAnswers } from "../queue/queue.js";
import { nothingChosen } from "../state.js";
import type { Moment } from "./moment.js";
import type { Queueing } from "./queueing.js";
import { complain, tell, type World } from "./world.js";

export class Adopting {
  constructor(
    private readonly world: World,
    private readonly queueing: Queueing,
    private readonly moment: Moment,
  ) {}

  /** Takes over what is said of some scans now. */
  async adopt(sequence: string, answered: readonly ScanCorrections[]): Promise<void> {
    const { store, loader } = this.world;
    if (sequence !== store.state.sequence) return answered.forEach((id) => loader.forget(sequence, id));
    const { cloud, scans, progress } = store.state;
    const onScreen = cloud.scans.flatMap((scan) => {
      const answer = answered.find((other) => sameScan(other, scan));
      return answer === undefined ? [] : [{ scan, now: withCorrections(scan, answer) }];
    });
    const changed = onScreen.flatMap(({ now }) => (now === null ? [] : [now]));
    for (const answer of answered) loader.forget(sequence, answer);
    for (const scan of changed) loader.keep(sequence, scan);
    const counted = withAnswers(scans, answered);
    store.set({ cloud: withScans(cloud, changed), scans: counted, progress: progressOf(counted, progress) });
    if (answered.length > 0) this.queueing.soon();
    await this.reread(
      sequence,
      onScreen.filter(({ now }) => now === null).map(({ scan }) => scan),
    );
  }

  /** Reads scans on screen anew; false where they hold other detections by now, which is told. */
  async reread(sequence: string, stale: readonly Scan[]): Promise<boolean> {
    const { store, loader } = this.world;
    // Radars have the same names in another sequence, and scans the same numbers.
    const isHere = (): boolean => sequence === store.state.sequence;
    if (!isHere() || stale.length === 0) return true;
    for (const scan of stale) loader.forget(sequence, scan);
    const fresh = await loader.newest(sequence, stale);
    if (!isHere()) return true;
    const { cloud } = store.state;
    const still = holdsStill(cloud, fresh);
    if (still) store.set({ cloud: withScans(cloud, fresh) });
    else await this.startOver();
    return still;
  }

  /** Nothing that was chosen among the detections on screen means anything among those that are there now. */
  private async startOver(): Promise<void> {
    const { store, loader } = this.world;
    loader.forgetScans();
    store.set({ ...nothingChosen(store.state), accepting: null });
    tell(this.world, "The recording holds other detections of this moment now: look at it again.");
    if (store.state.current !== null) await this.moment.show(store.state.current);
  }

  /** The labels are others than those on screen: everything that was read of them is read anew. */
  async readAllAnew(): Promise<void> {
    await this.rereadAll();
    await this.queueing.read();
  }

  /** Forgets all scans, and reads those on screen anew. */
  async rereadAll(): Promise<void> {
    const { store, loader } = this.world;
    loader.forgetScans();
    await this.reread(store.state.sequence, store.state.cloud.scans);
  }

  /** Says why something was not done, and shows what is there in its place. */
  async refused(sequence: string, done: string, error: unknown): Promise<void> {
    if (!(error instanceof Conflict)) return complain(this.world, error);
    const { conflict, scans, stale } = error.body;
    const failed = (problem: unknown): void => complain(this.world, problem);
    if (stale) await this.readAllAnew().catch(failed);
    else await this.adopt(sequence, scans).catch(failed);
    const where = sequence === this.world.store.state.sequence ? "" : ` in sequence ${sequence}`;
    const by = conflict === null ? "" : ` (${conflict.author}, ${conflict.tool})`;
    complain(this.world, `Not ${done}${where}${by}: ${error.message}`);
  }
}
