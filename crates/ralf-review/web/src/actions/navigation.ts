/** Going from scan to scan and from sequence to sequence. */

import type { ScanId } from "../api/types.js";
import { sameScan } from "../data/scan.js";
import { listed, neighbour, nextNeedy, type QueueView } from "../queue/queue.js";
import { type Address, addressText } from "./address.js";
import type { Moment } from "./moment.js";
import { complain, tell, type World } from "./world.js";

const MOST_ACCUMULATED = 20;

export class Navigation {
  constructor(
    private readonly world: World,
    private readonly moment: Moment,
  ) {}

  /** Opens a sequence at a scan, or else at the one that needs a person most. */
  async open(sequence: string, at: Address["scan"] = null): Promise<void> {
    const { store, api } = this.world;
    try {
      const [queue, history] = await Promise.all([api.queue(sequence), api.history(sequence)]);
      const { radar } = store.state.queueView;
      const known = queue.scans.some((scan) => scan.radar === radar);
      const queueView = { ...store.state.queueView, radar: known ? radar : null };
      store.set({
        sequence,
        scans: queue.scans,
        progress: queue.progress,
        history,
        queueView,
        cameras: [],
        chosenCamera: null,
      });
      const asked = queue.scans.find((scan) => scan.radar === at?.radar && scan.scan === at.scan);
      const first = asked ?? nextNeedy(queue.scans, null) ?? queue.scans[0];
      if (first === undefined) store.set({ loading: false, current: null });
      else await this.goTo(first);
    } catch (error) {
      store.set({ loading: false });
      complain(this.world, error);
    }
  }

  async goTo({ radar, scan }: ScanId): Promise<void> {
    const { sequence } = this.world.store.state;
    const address: Address = { sequence, scan: { radar, scan } };
    window.history.replaceState(null, "", addressText(address));
    await this.moment.show({ radar, scan });
    const next = nextNeedy(this.world.store.state.scans, { radar, scan });
    // What can't be read ahead is told of when somebody goes there.
    if (next !== null) await this.moment.prefetch(next).catch(() => undefined);
  }

  async nextNeedy(): Promise<void> {
    const { scans, current, queueView } = this.world.store.state;
    const ofRadar = listed(scans, { ...queueView, order: "need", hideReviewed: false });
    const next = nextNeedy(ofRadar, current);
    if (next === null) tell(this.world, "Every scan of this sequence is reviewed.");
    else await this.goTo(next);
  }

  async step(by: number): Promise<void> {
    const { scans, current } = this.world.store.state;
    const next = current === null ? null : neighbour(scans, current, by);
    if (next !== null) await this.goTo(next);
  }

  /** Along the list as it's shown. */
  async stepInList(by: number): Promise<void> {
    const { scans, current, queueView } = this.world.store.state;
    const rows = listed(scans, queueView);
    const next = rows[rows.findIndex((entry) => sameScan(entry, current)) + by];
    if (next !== undefined) await this.goTo(next);
  }

  /** To the same moment of the next radar. */
  async nextRadar(): Promise<void> {
    const { cloud, current } = this.world.store.state;
    const radars = [...new Set(cloud.scans.map(({ radar }) => radar))].sort();
    const wanted = radars[(radars.indexOf(current?.radar ?? "") + 1) % radars.length];
    const now = BigInt(cloud.scans[0]?.table.header.t_ns ?? 0);
    const apart = (time: string): bigint => (BigInt(time) > now ? BigInt(time) - now : now - BigInt(time));
    const scans = cloud.scans.filter(({ radar }) => radar === wanted);
    const [nearest] = scans.sort((a, b) => Number(apart(a.table.header.t_ns) - apart(b.table.header.t_ns)));
    if (nearest !== undefined) await this.goTo(nearest);
  }

  async accumulate(by: number): Promise<void> {
    const { store } = this.world;
    const { accumulate, current } = store.state;
    const wanted = Math.min(Math.max(accumulate + by, 0), MOST_ACCUMULATED);
    if (wanted === accumulate || current === null) return;
    store.set({ accumulate: wanted });
    await this.moment.show(current);
  }

  viewQueue(patch: Partial<QueueView>): void {
    const { store } = this.world;
    store.set({ queueView: { ...store.state.queueView, ...patch } });
  }
}
