/** What was ever said of the detection that is chosen, or of the thing that wants an answer. */

import type { ScanId } from "../api/types.js";
import { type Cloud, pointOf } from "../data/cloud.js";
import { countOf } from "../selection/mask.js";
import { complain, type World } from "./world.js";

/** Whoever goes from detection to detection isn't followed by requests. */
const PATIENCE_MS = 120;

interface Asked {
  readonly scan: ScanId;
  readonly point: number;
  readonly thing: boolean;
}

export class Recalling {
  private waiting: ReturnType<typeof setTimeout> | undefined;
  private generation = 0;

  constructor(private readonly world: World) {
    world.store.watch(
      ({ selection, cloud, thing, disputed, history }) => [selection, cloud, thing, disputed, history],
      (selection, cloud) => this.ask(selection, cloud),
    );
  }

  private ask(selection: Uint8Array, cloud: Cloud): void {
    const generation = ++this.generation;
    clearTimeout(this.waiting);
    if (this.world.store.state.past !== null) this.world.store.set({ past: null });
    const asked = this.asked(selection, cloud);
    if (asked === null) return;
    const read = async (): Promise<void> => {
      const { store, api } = this.world;
      const past = await api.past(store.state.sequence, asked.scan, asked.point, asked.thing);
      if (generation === this.generation) store.set({ past });
    };
    this.waiting = setTimeout(() => void read().catch((error: unknown) => complain(this.world, error)), PATIENCE_MS);
  }

  /** The one detection that is selected; of many, the thing where they are one. */
  private asked(selection: Uint8Array, cloud: Cloud): Asked | null {
    const { thing, disputed } = this.world.store.state;
    const whole = disputed ?? thing;
    if (whole !== null) return { scan: whole, point: whole.point, thing: true };
    if (selection.length !== cloud.count || countOf(selection) !== 1) return null;
    const { scan, point } = pointOf(cloud, selection.indexOf(1));
    return { scan, point, thing: false };
  }
}
