/** Choosing detections, and what is set by it. */

import type { Choice } from "../data/labels.js";
import { counted } from "../format.js";
import { combine, type Combination, countOf, intersection, inverted } from "../selection/mask.js";
import { isPress, type Tool } from "../selection/tools.js";
import { nothingChosen, NOTHING_LOOKED_AT } from "../state.js";
import { askedAbout } from "./asked.js";
import type { Correcting } from "./correcting.js";
import type { Kinding } from "./kinding.js";
import type { Settling } from "./settling.js";
import type { Thinging } from "./thinging.js";
import { complain, tell, type World } from "./world.js";

const BRUSHES = [6, 9, 13, 18, 26, 38, 54, 80] as const;

export class Selecting {
  /** The tool by which the selection came about; the server notes it with the stroke. */
  private lastTool: string = "click";
  /** True from an answer until the thing after it is on screen. */
  private answering = false;

  constructor(
    private readonly world: World,
    private readonly correcting: Correcting,
    private readonly things: Thinging,
    private readonly settling: Settling,
    private readonly kinds: Kinding,
  ) {}

  hover(index: number): void {
    if (this.world.store.state.hover !== index) this.world.store.set({ hover: index });
  }

  /** A finished gesture of a tool: selects, or sets the armed label at once. */
  gesture(tool: Tool, drawn: Uint8Array, how: Combination): void {
    const { store } = this.world;
    const { armed, selection, outbox } = store.state;
    if (outbox.kind === "conflict") return;
    this.lastTool = tool;
    const chosen = tool === "thing" && countOf(drawn) > 0 ? this.things.whole(drawn) : drawn;
    const mask = how === "add" ? this.withinTheQuestion(chosen) : chosen;
    if (countOf(chosen) === 0 && !isPress(tool)) this.explainNothing();
    // Whoever chooses something else isn't answering the queue any more.
    store.set(how === "replace" ? NOTHING_LOOKED_AT : { thing: null });
    if (armed !== undefined && how === "replace") {
      store.set({ selection: mask });
      this.begin(this.correcting.apply(armed, tool));
      return;
    }
    // A brush paints stroke by stroke; starting over each time would make it useless.
    const kept = tool === "brush" && how === "replace" ? "add" : how;
    store.set({ selection: combine(selection, mask, kept) });
  }

  /** A label was chosen: it's set on what is selected; with nothing selected, on every stroke from now on. */
  choose(choice: Choice): void {
    const { store } = this.world;
    const { selection, armed, thing, disputed, kind } = store.state;
    if (this.proposed()) return;
    if (disputed !== null) return this.settling.answer(choice);
    if (kind !== null) return this.kinds.answer(choice);
    if (countOf(selection) > 0 && thing !== null) this.begin(this.answer(choice));
    else if (countOf(selection) > 0) this.begin(this.correcting.apply(choice, this.lastTool));
    // A key that is pressed twice, or too early for the next thing, begins no painting.
    else if (!this.answering && !this.things.coming) store.set({ armed: armed === choice ? undefined : choice });
  }

  /** What a person says of the thing that wants an answer; then to the next one. */
  private async answer(choice: Choice): Promise<void> {
    this.answering = true;
    try {
      await this.correcting.apply(choice, "thing");
      const { outbox, selection } = this.world.store.state;
      // Whoever has begun something else meanwhile goes on with that.
      if (outbox.kind === "idle" && countOf(selection) === 0) await this.things.next();
    } finally {
      this.answering = false;
    }
  }

  /** Whether what is selected is what a proposal would change: that is accepted or dropped, never all one class. */
  private proposed(): boolean {
    if (this.world.store.state.opinion === null) return false;
    tell(this.world, "A proposal is looked at: Shift+R accepts it, Esc drops it.");
    return true;
  }

  disarm(): void {
    this.world.store.set({ armed: undefined });
  }

  flip(): void {
    const { disputed, kind } = this.world.store.state;
    if (this.proposed() || disputed !== null || kind !== null) return;
    this.begin(this.correcting.flip(this.lastTool));
  }

  invert(): void {
    const { store } = this.world;
    store.set({ ...NOTHING_LOOKED_AT, selection: inverted(store.state.selection, store.state.eligible) });
    this.lastTool = "invert";
  }

  all(tool = "all"): void {
    const { store } = this.world;
    store.set({ ...NOTHING_LOOKED_AT, selection: store.state.eligible.slice() });
    this.lastTool = tool;
  }

  /** Clears the selection, else what is armed. */
  escape(): void {
    const { store } = this.world;
    const { selection, thing } = store.state;
    if (countOf(selection) > 0) store.set(nothingChosen(store.state));
    else store.set({ ...NOTHING_LOOKED_AT, thing, armed: undefined, notice: null, accepting: null, drawing: null });
  }

  tool(tool: Tool): void {
    this.world.store.set({ tool, drawing: null });
    if (tool === "thing") this.begin(this.things.load().then(() => undefined));
  }

  /** The next larger or smaller brush; while a kind is looked at, more or fewer of it. */
  brush(step: 1 | -1): void {
    const { store } = this.world;
    if (store.state.kind !== null) return this.kinds.move(step);
    const now = BRUSHES.findIndex((radius) => radius >= store.state.brush);
    store.set({ brush: BRUSHES[Math.min(Math.max(now + step, 0), BRUSHES.length - 1)] });
  }

  toggleScope(): void {
    const { store } = this.world;
    store.set({ scope: store.state.scope === "scan" ? "shown" : "scan" });
  }

  toggleProtect(): void {
    const { store } = this.world;
    store.set({ protect: !store.state.protect });
  }

  /** What may be added to the answer of a question that is looked at: all of it, and nothing beyond, which is told. */
  private withinTheQuestion(chosen: Uint8Array): Uint8Array {
    const asked = askedAbout(this.world.store.state);
    if (asked === null) return chosen;
    const within = intersection(chosen, asked);
    const beyond = countOf(chosen) - countOf(within);
    if (beyond > 0)
      tell(this.world, `${counted(beyond, "detection")} that the question isn't about can't be added: Esc leaves it.`);
    return within;
  }

  private explainNothing(): void {
    const { scope, cloud } = this.world.store.state;
    const others = scope === "scan" && cloud.scans.length > 1;
    tell(
      this.world,
      others ? "Nothing of this scan there. E lets strokes change everything shown." : "Nothing there to select.",
    );
  }

  private begin(work: Promise<void>): void {
    work.catch((error: unknown) => complain(this.world, error));
  }
}
