/** Choosing detections, and what is set by it. */

import type { Choice } from "../data/labels.js";
import { combine, type Combination, countOf, inverted } from "../selection/mask.js";
import type { Tool } from "../selection/tools.js";
import type { Correcting } from "./correcting.js";
import { complain, tell, type World } from "./world.js";

const BRUSHES = [6, 9, 13, 18, 26, 38, 54, 80] as const;

export class Selecting {
  /** The tool by which the selection came about; the server notes it with the stroke. */
  private lastTool: string = "click";

  constructor(
    private readonly world: World,
    private readonly correcting: Correcting,
  ) {}

  hover(index: number): void {
    if (this.world.store.state.hover !== index) this.world.store.set({ hover: index });
  }

  /** A finished gesture of a tool: selects, or sets the armed label at once. */
  gesture(tool: Tool, mask: Uint8Array, how: Combination): void {
    const { store } = this.world;
    const { armed, selection, outbox } = store.state;
    if (outbox.kind === "conflict") return;
    this.lastTool = tool;
    if (countOf(mask) === 0 && tool !== "click") this.explainNothing();
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
    const { selection, armed } = store.state;
    if (countOf(selection) > 0) this.begin(this.correcting.apply(choice, this.lastTool));
    else store.set({ armed: armed === choice ? undefined : choice });
  }

  disarm(): void {
    this.world.store.set({ armed: undefined });
  }

  flip(): void {
    this.begin(this.correcting.flip(this.lastTool));
  }

  invert(): void {
    const { store } = this.world;
    store.set({ selection: inverted(store.state.selection, store.state.eligible) });
    this.lastTool = "invert";
  }

  all(): void {
    const { store } = this.world;
    store.set({ selection: store.state.eligible.slice() });
    this.lastTool = "all";
  }

  /** Clears the selection, else what is armed. */
  escape(): void {
    const { store } = this.world;
    const { selection } = store.state;
    if (countOf(selection) > 0) store.set({ selection: new Uint8Array(selection.length) });
    else store.set({ armed: undefined, notice: null, accepting: null });
  }

  tool(tool: Tool): void {
    this.world.store.set({ tool });
  }

  brush(step: 1 | -1): void {
    const { store } = this.world;
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
