/** Going from scan to scan and from sequence to sequence. */

import type { ScanId } from "../api/types.js";
import { buildCloud } from "../data/cloud.js";
import { sameScan } from "../data/scan.js";
import { listed, neighbour, nextNeedy, type QueueView } from "../queue/queue.js";
import { isOnScreen, MOST_ACCUMULATED } from "../state.js";
import { type Address, addressText } from "./address.js";
import type { Moment } from "./moment.js";
import { complain, tell, type World } from "./world.js";

/** How long a scan stays on screen at least while the recording plays, ms. */
const LEAST_SHOWN = 150;

export class Navigation {
  private playing = false;
  /** Counts what was opened: an answer that comes after a later choice changes nothing. */
  private opened = 0;

  constructor(
    private readonly world: World,
    private readonly moment: Moment,
  ) {}

  /** Opens a sequence at a scan, or else at the one that needs a person most. */
  async open(sequence: string, at: Address["scan"] = null): Promise<void> {
    const { store, api } = this.world;
    const opened = ++this.opened;
    try {
      const [queue, history] = await Promise.all([api.queue(sequence), api.history(sequence)]);
      if (opened !== this.opened) return;
      const before = store.state;
      const { radar } = before.queueView;
      // Nobody told of changes to a sequence that was not on screen.
      if (sequence !== before.sequence) this.world.loader.forgetScans();
      const known = queue.scans.some((scan) => scan.radar === radar);
      const queueView = { ...before.queueView, radar: known ? radar : null };
      store.set({
        sequence,
        scans: queue.scans,
        progress: queue.progress,
        progressElsewhere: new Map(before.progressElsewhere).set(before.sequence, before.progress),
        // Names of radars and numbers of scans are alike in all sequences: nothing of another may stay on screen.
        cloud: buildCloud([]),
        lidar: null,
        history,
        queueView,
        cameras: [],
        chosenCamera: null,
      });
      const asked = queue.scans.find((scan) => scan.radar === at?.radar && scan.scan === at.scan);
      const first = asked ?? nextNeedy(queue.scans, null) ?? queue.scans[0];
      if (first === undefined) this.nothing(sequence);
      else await this.goTo(first);
    } catch (error) {
      if (opened !== this.opened) return;
      store.set({ loading: false });
      complain(this.world, error);
    }
  }

  /** A sequence without a scan for this person, which is said. */
  private nothing(sequence: string): void {
    const { store } = this.world;
    const { second } = store.state.recording;
    store.set({ loading: false, current: null });
    const whose = second === null ? "has no labelled scans" : `has no scans for ${second} to label a second time`;
    tell(this.world, `Sequence ${sequence} ${whose}.`);
  }

  /** Reads how far the labelled sequences are, one after the other. */
  async readProgress(): Promise<void> {
    const { store, api } = this.world;
    const others = store.state.recording.sequences.filter(
      ({ name, labelled }) => labelled && name !== store.state.sequence,
    );
    try {
      for (const { name } of others) {
        const progress = await api.progress(name);
        store.set({ progressElsewhere: new Map(store.state.progressElsewhere).set(name, progress) });
      }
    } catch (error) {
      complain(this.world, error);
    }
  }

  async goTo({ radar, scan }: ScanId): Promise<void> {
    const { sequence } = this.world.store.state;
    const address: Address = { sequence, scan: { radar, scan } };
    window.history.replaceState(null, "", addressText(address));
    await this.moment.show({ radar, scan });
    void this.readAhead({ radar, scan });
  }

  /** Once all of a scan is there, reads the one after it; what can't be read is told of when somebody goes there. */
  private async readAhead(id: ScanId): Promise<void> {
    await this.moment.pictured();
    const { scans, current } = this.world.store.state;
    const next = sameScan(current, id) ? nextNeedy(scans, id) : null;
    if (next !== null) await this.moment.prefetch(next).catch(() => undefined);
  }

  async nextNeedy(): Promise<void> {
    const { scans, current, queueView } = this.world.store.state;
    const ofRadar = listed(scans, { ...queueView, order: "need", hideReviewed: false });
    const next = nextNeedy(ofRadar, current);
    const whose = queueView.radar === null ? "this sequence" : `${queueView.radar} in this sequence`;
    if (next === null) tell(this.world, `Every scan of ${whose} is reviewed.`);
    else await this.goTo(next);
  }

  async step(by: number): Promise<void> {
    const { scans, current } = this.world.store.state;
    const next = current === null ? null : neighbour(scans, current, by);
    if (next !== null) await this.goTo(next);
  }

  /** Goes from scan to scan of the radar by itself, until it is asked again or the last one is there. */
  async play(): Promise<void> {
    this.playing = !this.playing;
    while (this.playing) {
      const { current, sequence } = this.world.store.state;
      const shown = new Promise((resolve) => setTimeout(resolve, LEAST_SHOWN));
      await this.step(1);
      await Promise.all([shown, this.moment.pictured()]);
      const now = this.world.store.state;
      if (sameScan(current, now.current) || sequence !== now.sequence) this.playing = false;
    }
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

  /** All scans around one (a hundred of each radar before and after it) on screen, and strokes that may change them. */
  async wholeSequence(at: ScanId): Promise<void> {
    const { store } = this.world;
    const { accumulate, scope } = store.state;
    if (scope !== "shown") store.set({ scope: "shown" });
    if (accumulate !== MOST_ACCUMULATED) store.set({ accumulate: MOST_ACCUMULATED });
    const there = accumulate === MOST_ACCUMULATED && isOnScreen(store.state, at);
    if (!there) await this.goTo(at);
  }

  /** Between all scans around the current one, and it alone. */
  async toggleWhole(): Promise<void> {
    const { store } = this.world;
    const { accumulate, current } = store.state;
    if (current === null) return;
    if (accumulate < MOST_ACCUMULATED) return this.wholeSequence(current);
    store.set({ accumulate: 0, scope: "scan" });
    await this.moment.show(current);
  }

  viewQueue(patch: Partial<QueueView>): void {
    const { store } = this.world;
    store.set({ queueView: { ...store.state.queueView, ...patch } });
  }
}
