/** Kinds: detections all over a sequence that one question is about, the one whose answer is worth most first. */

import type { Kind } from "../api/kinds.js";
import { type Cloud, findScan, maskOf } from "../data/cloud.js";
import type { Choice } from "../data/labels.js";
import { lineAt, linesOf, within } from "../data/kinds.js";
import { keptPoints } from "../data/opinion.js";
import { countOf, intersection } from "../selection/mask.js";
import { type Focus, nothingChosen, NOTHING_LOOKED_AT } from "../state.js";
import type { Correcting } from "./correcting.js";
import { LookedIn } from "./looked-in.js";
import type { Navigation } from "./navigation.js";
import { complain, tell, type World } from "./world.js";

/** How much of the world is shown around a kind at least, m. */
const LEAST_SHOWN = 24;

export class Kinding {
  /** Kinds that were asked about since the sequence was opened: what is left of them is right for most. */
  private passed = new Set<string>();
  /** The one that was asked for last and did not come on screen. */
  private missed: string | null = null;
  private readonly lookedIn: LookedIn;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly correcting: Correcting,
  ) {
    const { store } = world;
    store.watch(
      ({ sequence }) => [sequence],
      () => {
        this.passed = new Set();
        store.set({ kind: null });
      },
    );
    this.lookedIn = new LookedIn(store, () => this.left());
  }

  /** To the kind that is worth most; the one that is looked at is passed over. */
  async next(): Promise<void> {
    const { store } = this.world;
    if (store.state.current === null || !(await this.correcting.free("asking about kinds"))) return;
    if (store.state.thinking) return;
    const passed = store.state.kind;
    if (passed !== null) this.passed.add(passed.kind);
    try {
      await this.ask();
    } catch (error) {
      complain(this.world, error);
    }
  }

  /** Draws the line between what is asked about and what isn't elsewhere: at one of `linesOf`. */
  draw(line: number): void {
    const { store } = this.world;
    const { kind, cloud, selection, eligible } = store.state;
    if (kind === null || selection.length !== cloud.count) return;
    const lines = linesOf(kind.detections);
    const other = { ...kind, asked: lines[Math.max(0, Math.min(lines.length - 1, line))] };
    // What was spared with a tool stays spared.
    const before = maskOf(cloud, within(kind));
    const spared = selection.map((is, i) => before[i] & eligible[i] & (1 - is));
    const wanted = intersection(maskOf(cloud, within(other)), eligible);
    store.set({ kind: other, selection: wanted.map((is, i) => is & (1 - spared[i])) });
  }

  /** Draws the line a step farther on, or back. */
  move(step: number): void {
    const { kind } = this.world.store.state;
    if (kind !== null) this.draw(lineAt(linesOf(kind.detections), kind.asked) + step);
  }

  /** Says what all that is selected of it is, as one step, and goes on. */
  answer(choice: Choice): void {
    this.say(choice).catch((error: unknown) => complain(this.world, error));
  }

  private async say(choice: Choice): Promise<void> {
    const { store } = this.world;
    const { kind, cloud, selection } = store.state;
    if (kind === null) return;
    const points = keptPoints(within(kind), cloud, selection);
    if (points.length === 0) return tell(this.world, "None of these is selected, so nothing is said of them.");
    // What was spared and what lies beyond the line stays as it is, which is an answer, too.
    this.passed.add(kind.kind);
    if (!(await this.correcting.answerKind(points, kind.base, choice))) return;
    if (store.state.outbox.kind === "idle") await this.ask();
  }

  private async ask(): Promise<void> {
    const { store, api } = this.world;
    const { sequence } = store.state;
    store.set({ ...nothingChosen(store.state), thinking: true });
    try {
      const tNs = store.state.cloud.scans[0]?.table.header.t_ns ?? "0";
      const { next, kinds, base, scans } = await api.kinds(sequence, tNs, [...this.passed]);
      if (sequence !== store.state.sequence) return;
      if (next === null) return tell(this.world, "No other kind of detection is probably wrong in this sequence.");
      // Nobody's work is taken over: what was begun meanwhile comes first.
      const { thing, opinion, selection } = store.state;
      if (thing !== null || opinion !== null || countOf(selection) > 0)
        return tell(this.world, "A kind is known that may be wrong, but you are at something: Shift+G shows it.");
      const lines = linesOf(next.detections);
      await this.show({ ...next, asked: lines[lineAt(lines, next.asked)], base, left: kinds - 1, scans });
    } finally {
      store.set({ thinking: false });
    }
  }

  private async show(kind: Kind): Promise<void> {
    const { store } = this.world;
    const { sequence, current } = store.state;
    const isHere = (): boolean => kind.points.some((part) => findScan(store.state.cloud, part) >= 0);
    await this.lookedIn.elsewhere(async () => {
      await this.navigation.wholeSequence(current ?? kind);
      if (!isHere()) await this.navigation.wholeSequence(kind);
    });
    if (sequence !== store.state.sequence) return;
    const { cloud, eligible, loading } = store.state;
    if (loading || !isHere()) return this.miss(kind);
    const selection = intersection(maskOf(cloud, within(kind)), eligible);
    this.lookedIn.here();
    store.set({ ...NOTHING_LOOKED_AT, kind, selection, armed: undefined, focus: around(cloud, selection) });
  }

  /** It isn't on screen: somebody went elsewhere meanwhile, or, the second time, its scans can't be read. */
  private miss({ kind }: Kind): void {
    if (this.missed === kind) this.passed.add(kind);
    this.missed = kind;
  }

  /** Whoever looks at other scans doesn't see any more what is spared, and what isn't. */
  private left(): void {
    if (this.world.store.state.kind === null) return;
    this.world.store.set({ kind: null });
    tell(this.world, "The question is left, for you look at something else: Shift+G asks again.");
  }
}

/** All of the chosen in one picture; `null` where none is on screen. */
function around({ positions }: Cloud, chosen: Uint8Array): Focus | null {
  const axis = (at: 0 | 1): readonly [number, number] => {
    let [least, most] = [Infinity, -Infinity];
    chosen.forEach((is, i) => {
      const value = positions[3 * i + at];
      if (is === 0 || !Number.isFinite(value)) return;
      [least, most] = [Math.min(least, value), Math.max(most, value)];
    });
    return [least, most];
  };
  const [[left, right], [low, high]] = [axis(0), axis(1)];
  if (left > right) return null;
  return { x: (left + right) / 2, y: (low + high) / 2, span: Math.max(LEAST_SHOWN, right - left, high - low) };
}
