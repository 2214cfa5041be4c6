/** Going from doubtful thing to doubtful thing: each is looked at over the whole sequence, and answered at once. */

import type { DoubtfulThing } from "../api/types.js";
import { maskOf } from "../data/cloud.js";
import { nextThing, placeOf, type Place, Things, wholeThings } from "../data/things.js";
import { movePlace } from "../data/transform.js";
import { countOf, intersection } from "../selection/mask.js";
import { isOnScreen, nothingChosen, NOTHING_LOOKED_AT } from "../state.js";
import type { Adopting } from "./adopting.js";
import type { Navigation } from "./navigation.js";
import { complain, tell, type World } from "./world.js";

/** How much of the world is shown around a thing, m. */
const AROUND = 24;

export class Thinging {
  private loading: Promise<Things> | null = null;
  /** What belongs together over the sequence; `null` until somebody asks. */
  private things: Things | null = null;
  private doubtful: readonly DoubtfulThing[] = [];
  /** Places that were looked at since the sequence was opened. */
  private seen: Place[] = [];
  /** How many are on their way to the screen: somebody may ask again before the first is there. */
  private underWay = 0;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly adopting: Adopting,
  ) {
    world.store.watch(
      ({ sequence }) => [sequence],
      () => {
        this.forget();
        world.store.set({ thing: null });
      },
    );
  }

  /** Reads what belongs together, once per sequence and run. */
  load(): Promise<Things> {
    const { store, api } = this.world;
    const { sequence } = store.state;
    const reading = (this.loading ??= api.things(sequence).then((table) => {
      const things = new Things(table);
      if (sequence === store.state.sequence) [this.things, this.doubtful] = [things, table.header.doubtful];
      return things;
    }));
    reading.catch(() => (this.loading = null));
    return reading;
  }

  /** True from the moment the next thing is asked for until it is on screen. */
  get coming(): boolean {
    return this.underWay > 0;
  }

  /** To the next place where wrong labels are expected, with its most doubtful thing selected. */
  async next(): Promise<void> {
    const { store } = this.world;
    const { sequence } = store.state;
    this.underWay += 1;
    store.set(nothingChosen(store.state));
    try {
      if (this.things === null) await this.load();
      else await this.hear(sequence);
      if (sequence !== store.state.sequence) return;
      // Nobody's work is taken over: what was begun meanwhile comes first.
      if (countOf(store.state.selection) > 0)
        return tell(this.world, "The next thing is known, but you are at something: Shift+N shows it after that.");
      const next = nextThing(this.doubtful, this.seen);
      if (next !== null) return await this.show(next);
      tell(this.world, "Every doubtful thing of this sequence was looked at.");
    } catch (error) {
      complain(this.world, error);
    } finally {
      this.underWay -= 1;
    }
  }

  /** Hears what is doubtful by now: numbers of things, and those of another run are of other things. */
  private async hear(sequence: string): Promise<void> {
    const { store, api } = this.world;
    const { run, doubtful } = await api.doubtful(sequence);
    if (sequence !== store.state.sequence) return;
    if (run === this.things?.run) this.doubtful = doubtful;
    else await this.loadAnew();
  }

  /** Somebody labelled again: what belonged together, and what was looked at, was of other labels. */
  private async loadAnew(): Promise<void> {
    this.forget();
    await this.adopting.readAllAnew();
    await this.load();
  }

  private forget(): void {
    [this.loading, this.things] = [null, null];
    [this.doubtful, this.seen] = [[], []];
  }

  /** Puts a thing on screen, with all that is known of its place. */
  async show(thing: DoubtfulThing): Promise<void> {
    const { store } = this.world;
    const { sequence } = store.state;
    const things = await this.load();
    // Once: a scan that can't be read must not be asked for again and again.
    const at = placeOf(thing);
    if (at !== null) this.seen.push(at);
    await this.navigation.wholeSequence(thing);
    // Somebody went elsewhere meanwhile, where these numbers mean nothing, or the scan can't be read.
    if (sequence !== store.state.sequence || !isOnScreen(store.state, thing)) return;
    lookAt(this.world, thing);
    // Whoever paints goes on painting there.
    if (store.state.armed !== undefined) return;
    const { cloud, eligible } = store.state;
    const selection = intersection(maskOf(cloud, things.members(thing.thing)), eligible);
    if (countOf(selection) === 0)
      return tell(this.world, "The filter hides all of the next thing: 0 shows everything, Shift+N goes on.");
    store.set({ ...NOTHING_LOOKED_AT, thing, selection, tool: "thing" });
  }

  /** The things of what was chosen, as far as they are shown. */
  whole(chosen: Uint8Array): Uint8Array {
    const { cloud, shown } = this.world.store.state;
    const { things } = this;
    const known = things !== null && cloud.scans.every(({ table }) => table.header.run === things.run);
    if (known) return wholeThings(things, cloud, chosen, shown);
    const loading = things === null ? this.load() : this.loadAnew();
    void loading.catch((error: unknown) => complain(this.world, error));
    tell(this.world, "Finding out what belongs together; choose again in a moment.");
    return chosen;
  }
}

/** Has the picture show the place of a thing, as far as it's known. */
export function lookAt({ store }: World, thing: DoubtfulThing): void {
  const at = placeOf(thing);
  if (at === null) return;
  const from = store.state.cloud.scans[0]?.table.header.odom_from_vehicle ?? null;
  const [x, y] = movePlace(from, [at[0], at[1], thing.place[2] ?? 0]);
  store.set({ focus: { x, y, span: Math.max(AROUND, 4 * (thing.radius ?? 0)) } });
}
