/** Reads the order of work anew after edits, one's own too: what was said of one scan tells of others. */

import { isAway } from "../api/errors.js";
import { keptPlace, withPlaceKept } from "../queue/queue.js";
import type { QueueScan, ScanId } from "../api/types.js";
import { complain, type World } from "./world.js";

/** Edits that follow each other this closely are waited for. */
const QUIET_MS = 700;

export class Queueing {
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** Counts what was asked for: an answer that an edit has overtaken changes nothing. */
  private asked = 0;
  /** The scan that is looked at, as it stood in the list when somebody went there. */
  private place: QueueScan | null = null;

  constructor(private readonly world: World) {
    world.store.watch(
      ({ current }) => [current],
      (current) => this.went(current),
    );
  }

  /** What was left goes where it belongs by now. */
  private went(current: ScanId | null): void {
    const { store } = this.world;
    const { scans } = store.state;
    const settled = withPlaceKept(scans, keptPlace(scans, this.place));
    this.place = keptPlace(settled, current);
    if (settled.some((entry, at) => entry !== scans[at])) store.set({ scans: settled });
  }

  /** Once nothing is edited for a moment. */
  soon(): void {
    this.asked += 1;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      // Whoever hears that the server is back reads it then.
      this.read().catch((error: unknown) => (isAway(error) ? undefined : complain(this.world, error)));
    }, QUIET_MS);
  }

  /** At once. */
  async read(): Promise<void> {
    const { store, api } = this.world;
    const { sequence } = store.state;
    const asked = ++this.asked;
    const { scans, progress } = await api.queue(sequence);
    if (asked !== this.asked || sequence !== store.state.sequence) return;
    store.set({ scans: withPlaceKept(scans, this.place), progress });
  }
}
