/** A rule on all sequences of a person: what it would change in each is shown, and one press makes it so. */

import { messageOf } from "../api/errors.js";
import { certaintyOf } from "../data/filter.js";
import { type Asking, nothingOf, type ReplayPart, sequencesOf, withScan } from "../data/replay.js";
import { readRules } from "../data/rules.js";
import { scanFromTable } from "../data/scan.js";
import { counted } from "../format.js";
import type { Correcting } from "./correcting.js";
import { complain, readOnly, tell, type World } from "./world.js";

/** So many scans are read at once. */
const AT_ONCE = 6;

export class Replaying {
  private generation = 0;

  constructor(
    private readonly world: World,
    private readonly correcting: Correcting,
  ) {
    // Whoever closes the list has nothing read on.
    world.store.watch(
      ({ dialog }) => [dialog],
      (dialog) => (dialog === "replay" ? undefined : this.end()),
    );
  }

  /** Asks a rule of all scans of all sequences, one after the other, and shows what it would change. */
  async start(name: string): Promise<void> {
    const { store } = this.world;
    const rule = readRules().find((known) => known.name === name);
    if (rule === undefined || rule.sets === null || readOnly(this.world)) return;
    if (rule.filter.areas.length > 0)
      return tell(this.world, `${name} asks for places, which are of one sequence: press its name there.`);
    if (!(await this.correcting.free("a rule on all sequences"))) return;
    const { labels, recording } = store.state;
    const certainty = certaintyOf(recording);
    const asking = { ...rule, sets: rule.sets, labels, certainty, causes: recording.sayable_causes };
    const generation = ++this.generation;
    const sequences = sequencesOf(recording, store.state.name);
    store.set({ replay: { name, sets: rule.sets, parts: [], all: sequences.length }, dialog: "replay" });
    for (const { name: sequence } of sequences) {
      const part = await this.read(sequence, asking, generation);
      const { replay } = store.state;
      if (generation !== this.generation || replay === null) return;
      store.set({ replay: { ...replay, parts: [...replay.parts, part] } });
    }
  }

  /** Makes it so, in each sequence as one stroke. */
  async apply(): Promise<void> {
    const { store } = this.world;
    if (!(await this.correcting.free("a rule on all sequences"))) return;
    const { replay } = store.state;
    if (replay === null || replay.parts.length < replay.all) return;
    store.set({ dialog: "none" });
    const parts = replay.parts.filter(({ points }) => points.length > 0);
    await this.correcting.replay(parts, replay.sets).catch((error: unknown) => complain(this.world, error));
    const changed = counted(
      parts.reduce((sum, part) => sum + part.detections, 0),
      "label",
    );
    if (store.state.outbox.kind === "idle")
      tell(this.world, `${changed} changed in ${counted(parts.length, "sequence")}; Ctrl+Z takes them back in each.`);
  }

  private end(): void {
    this.generation += 1;
    if (this.world.store.state.replay !== null) this.world.store.set({ replay: null });
  }

  /** What would change in a sequence; what can't be read is told, and nothing of that sequence is changed. */
  private async read(sequence: string, asking: Asking, generation: number): Promise<ReplayPart> {
    const { api } = this.world;
    let part = nothingOf(sequence);
    try {
      const { scans } = await api.queue(sequence);
      for (let first = 0; first < scans.length && generation === this.generation; first += AT_ONCE) {
        const some = scans.slice(first, first + AT_ONCE);
        const read = await Promise.all(some.map(async (id) => scanFromTable(id, await api.scan(sequence, id))));
        part = read.reduce((sum, scan) => withScan(sum, scan, asking), part);
      }
      return part;
    } catch (error) {
      return { ...nothingOf(sequence), problem: messageOf(error) };
    }
  }
}
