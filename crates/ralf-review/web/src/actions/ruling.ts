/** Rules: filters with a name, which choose everything they let through, in this sequence and in others. */

import { liesIn } from "../data/area.js";
import { keepRules, readRules, type Verdict } from "../data/rules.js";
import { homeOf, NOTHING_LOOKED_AT } from "../state.js";
import type { Correcting } from "./correcting.js";
import { LookedIn } from "./looked-in.js";
import type { Navigation } from "./navigation.js";
import type { Selecting } from "./selecting.js";
import { complain, tell, type World } from "./world.js";

const LONGEST_NAME = 64;

export class Ruling {
  private readonly lookedIn: LookedIn;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly selecting: Selecting,
    private readonly correcting: Correcting,
  ) {
    world.store.set({ rules: readRules() });
    // What a rule chose was chosen in the scans that were on screen: in others it has chosen nothing.
    this.lookedIn = new LookedIn(world.store, () => world.store.set({ rule: null }));
  }

  /** Keeps what the filter asks now under a name, in place of what had it before. */
  save(typed: string, sets: Verdict | null): void {
    const { store } = this.world;
    const name = typed.trim().slice(0, LONGEST_NAME);
    if (name === "") return;
    const others = readRules().filter((rule) => rule.name !== name);
    this.keep([...others, { name, filter: store.state.filter, sets }]);
    tell(this.world, `The rule ${name} is kept in this browser.`);
  }

  forget(name: string): void {
    this.keep(readRules().filter((rule) => rule.name !== name));
  }

  /** Shows what a rule lets through in the whole sequence, and selects it: a label may follow, or not. */
  async choose(name: string): Promise<void> {
    const { store } = this.world;
    const rule = readRules().find((known) => known.name === name);
    const { current, sequence } = store.state;
    if (rule === undefined || current === null) return;
    const elsewhere = rule.filter.areas.find((area) => !liesIn(area, homeOf(store.state)));
    if (elsewhere !== undefined)
      return tell(
        this.world,
        `${name} asks for places of sequence ${elsewhere.sequence} of ${elsewhere.dataset}: it chooses nothing here.`,
      );
    try {
      await this.navigation.wholeSequence(current);
      if (sequence !== store.state.sequence) return;
      store.set({ ...NOTHING_LOOKED_AT, filter: rule.filter, notice: null });
      this.selecting.all("rule");
      this.lookedIn.here();
      store.set({ rule: rule.sets === null ? null : rule });
    } catch (error) {
      complain(this.world, error);
    }
  }

  /** Does what the rule says, to what is still selected, as one stroke. */
  async apply(): Promise<void> {
    const { store } = this.world;
    const { rule } = store.state;
    if (rule === null || rule.sets === null) return;
    store.set({ rule: null });
    await this.correcting.apply(rule.sets.label, "rule", rule.sets.cause);
  }

  private keep(rules: ReturnType<typeof readRules>): void {
    keepRules(rules);
    this.world.store.set({ rules: readRules() });
  }
}
