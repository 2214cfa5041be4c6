/** Going from doubtful thing to doubtful thing: each is looked at over the whole sequence, and answered at once. */

import type { DoubtfulThing } from "../api/types.js";
import { maskOf } from "../data/cloud.js";
import { nextThing, placeOf, type Place, Things, wholeThings } from "../data/things.js";
import { movePlace } from "../data/transform.js";
import type { Navigation } from "./navigation.js";
import { complain, tell, type World } from "./world.js";

/** How much of the world is shown around a thing, m. */
const AROUND = 24;

export class Thinging {
  private loading: Promise<Things> | null = null;
  /** Places that were looked at since the sequence was opened. */
  private seen: Place[] = [];

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
  ) {
    world.store.watch(
      ({ sequence }) => [sequence],
      () => {
        this.loading = null;
        this.seen = [];
        world.store.set({ things: null, doubtful: [], thing: null });
      },
    );
  }

  /** Reads what belongs together, once per sequence. */
  load(): Promise<Things> {
    const { store, api } = this.world;
    const { sequence } = store.state;
    const reading = (this.loading ??= api.things(sequence).then((table) => {
      const things = new Things(table);
      if (sequence === store.state.sequence) store.set({ things, doubtful: table.header.doubtful });
      return things;
    }));
    reading.catch(() => (this.loading = null));
    return reading;
  }

  /** To the next place where wrong labels are expected, with its most doubtful thing selected. */
  async next(): Promise<void> {
    const { store, api } = this.world;
    const { sequence } = store.state;
    try {
      if (store.state.things === null) await this.load();
      else store.set({ doubtful: (await api.doubtful(sequence)).doubtful });
      const next = nextThing(store.state.doubtful, this.seen);
      if (next !== null) return await this.show(next);
      store.set({ thing: null });
      tell(this.world, "Every doubtful thing of this sequence was looked at.");
    } catch (error) {
      complain(this.world, error);
    }
  }

  /** Puts a thing on screen, with all that is known of its place. */
  async show(thing: DoubtfulThing): Promise<void> {
    const { store } = this.world;
    const things = await this.load();
    await this.navigation.wholeSequence(thing);
    const { cloud } = store.state;
    const at = placeOf(thing);
    if (at !== null) {
      this.seen.push(at);
      const from = cloud.scans[0]?.table.header.odom_from_vehicle ?? null;
      const [x, y] = movePlace(from, [at[0], at[1], thing.place[2] ?? 0]);
      store.set({ focus: { x, y, span: Math.max(AROUND, 4 * (thing.radius ?? 0)) } });
    }
    // Whoever paints goes on painting there.
    if (store.state.armed !== undefined) return;
    const selection = maskOf(cloud, things.members(thing.thing));
    store.set({ thing, selection, tool: "thing" });
  }

  /** The things of what was chosen, as far as they are shown. */
  whole(chosen: Uint8Array): Uint8Array {
    const { things, cloud, shown } = this.world.store.state;
    if (things !== null) return wholeThings(things, cloud, chosen, shown);
    void this.load().catch((error: unknown) => complain(this.world, error));
    tell(this.world, "Finding out what belongs together; choose again in a moment.");
    return chosen;
  }
}
