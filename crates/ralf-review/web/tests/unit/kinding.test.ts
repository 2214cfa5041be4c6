import assert from "node:assert/strict";
import { test } from "node:test";
import type { Correcting } from "../../src/actions/correcting.js";
import { Kinding } from "../../src/actions/kinding.js";
import type { Navigation } from "../../src/actions/navigation.js";
import { Picking } from "../../src/actions/picking.js";
import { Selecting } from "../../src/actions/selecting.js";
import type { Settling } from "../../src/actions/settling.js";
import type { Thinging } from "../../src/actions/thinging.js";
import type { World } from "../../src/actions/world.js";
import type { AskedKind, Kinds } from "../../src/api/kinds.js";
import type { BaseRevision, ScanId, ScanPoints } from "../../src/api/types.js";
import { buildCloud, type Cloud } from "../../src/data/cloud.js";
import { lineAt, linesOf } from "../../src/data/kinds.js";
import type { Choice } from "../../src/data/labels.js";
import { deriveAlways } from "../../src/derive.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

const HERE = { radar: "front", scan: 0 };
const WHOLE = buildCloud([made("front", 0, { x: [1, 2, 3] }), made("front", 1, { x: [4, 5] })]);
const ALONE = buildCloud([made("front", 0, { x: [1, 2, 3] })]);
const front = (scan: number, ...points: number[]): ScanPoints => ({ radar: "front", scan, points });

function asked(kind: string, points: readonly ScanPoints[]): AskedKind {
  const detections = points.reduce((sum, part) => sum + part.points.length, 0);
  const told = { label: 99, things: 2, expected_errors: 3, worth: 2, sign: "weak" } as const;
  const ranks = Array.from({ length: detections }, (_, i) => i);
  return { kind, points, detections, ranks, asked: detections, ...told, radar: "front", scan: 1 };
}

/** The last of the first is in a scan that is never on screen. */
const FIRST = asked("plausible-weak", [front(0, 0, 1), front(1, 0), front(9, 4)]);
const SECOND = asked("plausible-moves", [front(1, 1)]);

/** A page without a picture: what is said is noted, and every scan is there at once. */
class Table {
  readonly store = new Store<State>(initialState(recordingOf([sequence("00", "ada")]), "ada"));
  readonly said: { readonly points: readonly ScanPoints[]; readonly choice: Choice }[] = [];
  readonly passed: (readonly string[])[] = [];
  readonly kinding: Kinding;
  readonly selecting: Selecting;

  constructor() {
    const { store } = this;
    deriveAlways(store);
    const kinds = (_: string, __: string, passed: readonly string[]): Promise<Kinds> => {
      this.passed.push(passed);
      const left = [FIRST, SECOND].filter(({ kind }) => !passed.includes(kind) && !this.isSaid(kind));
      return Promise.resolve({ kinds: left.length, next: left[0] ?? null, base: [], scans: { looked_at: 2, all: 2 } });
    };
    const world = { store, api: { kinds } } as unknown as World;
    const wholeSequence = (_: ScanId): Promise<void> => Promise.resolve(this.picture(WHOLE));
    const answerKind = (
      points: readonly ScanPoints[],
      _: readonly BaseRevision[],
      choice: Choice,
    ): Promise<boolean> => {
      this.said.push({ points, choice });
      store.set({ kind: null, selection: new Uint8Array(store.state.cloud.count) });
      return Promise.resolve(true);
    };
    const correct = { answerKind, free: () => Promise.resolve(true) } as unknown as Correcting;
    this.kinding = new Kinding(world, { wholeSequence } as unknown as Navigation, correct);
    this.selecting = new Selecting(world, correct, {} as Thinging, {} as Settling, this.kinding);
    store.set({ sequence: "00", current: HERE, loading: false, cloud: ALONE, scope: "shown" });
  }

  picture(cloud: Cloud): void {
    if (this.store.state.cloud !== cloud) this.store.set({ cloud, selection: new Uint8Array(cloud.count) });
  }

  private isSaid(kind: string): boolean {
    return kind === FIRST.kind ? this.said.length > 0 : this.said.length > 1;
  }
}

const turn = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

async function looking(): Promise<Table> {
  const table = new Table();
  await table.kinding.next();
  assert.deepEqual([...table.store.state.selection], [1, 1, 0, 1, 0]);
  return table;
}

test("one key answers all of a kind, on screen and elsewhere, and goes on to the next", async () => {
  const { store, selecting, said, passed } = await looking();
  selecting.choose(1);
  await turn();
  assert.deepEqual(said, [{ points: FIRST.points, choice: 1 }]);
  assert.equal(store.state.kind?.kind, SECOND.kind);
  assert.deepEqual(passed, [[], [FIRST.kind]]);
});

test("what is spared isn't changed, and counts as right for the kinds after it", async () => {
  const { store, selecting, said, passed } = await looking();
  store.set({ selection: new Uint8Array([1, 0, 0, 1, 0]) });
  selecting.choose(1);
  await turn();
  assert.deepEqual(said[0].points, [front(0, 0), front(1, 0), front(9, 4)]);
  assert.deepEqual(passed, [[], [FIRST.kind]]);
});

test("the line is drawn elsewhere: what lies beyond it isn't changed, and what was spared stays so", async () => {
  const { store, kinding, selecting, said } = await looking();
  store.set({ selection: new Uint8Array([0, 1, 0, 1, 0]) });
  kinding.draw(1);
  assert.deepEqual([...store.state.selection], [0, 1, 0, 0, 0]);
  selecting.brush(1);
  assert.deepEqual([...store.state.selection], [0, 1, 0, 1, 0]);
  assert.equal(store.state.kind?.asked, 3);
  selecting.choose(1);
  await turn();
  assert.deepEqual(said, [{ points: [front(0, 1), front(1, 0)], choice: 1 }]);
});

test("the line stays among the detections of a kind", async () => {
  const { store, kinding } = await looking();
  kinding.move(9);
  assert.equal(store.state.kind?.asked, 4);
  kinding.draw(-3);
  assert.equal(store.state.kind?.asked, 1);
  assert.deepEqual([...store.state.selection], [1, 0, 0, 0, 0]);
});

test("a kind of many has twenty lines, a small one has one for each detection", () => {
  assert.deepEqual(linesOf(3), [1, 2, 3]);
  assert.equal(linesOf(571).length, 20);
  assert.equal(linesOf(571)[19], 571);
  assert.equal(lineAt(linesOf(100), 41), 8);
  assert.equal(lineAt(linesOf(3), 1), 0);
});

test("a kind that is passed over isn't asked about again, and nothing is said of it", async () => {
  const { store, kinding, said, passed } = await looking();
  await kinding.next();
  assert.equal(store.state.kind?.kind, SECOND.kind);
  await kinding.next();
  assert.equal(store.state.kind, null);
  assert.match(store.state.notice?.text ?? "", /No other kind/);
  assert.deepEqual(said, []);
  assert.deepEqual(passed, [[], [FIRST.kind], [FIRST.kind, SECOND.kind]]);
});

test("whoever looks at other scans, or selects anew, says nothing of a kind", async () => {
  for (const leave of [
    (table: Table) => table.picture(ALONE),
    (table: Table) => table.selecting.gesture("lasso", new Uint8Array([0, 0, 1, 0, 0]), "replace"),
    (table: Table) => table.selecting.escape(),
    (table: Table) => table.selecting.invert(),
    (table: Table) => table.selecting.all(),
    (table: Table) => new Picking({ store: table.store } as unknown as World).step(1),
  ]) {
    const table = await looking();
    leave(table);
    assert.equal(table.store.state.kind, null);
    table.kinding.answer(1);
    await turn();
    assert.deepEqual(table.said, []);
  }
});

test("what was spared of a kind can be added again, and nothing beyond it, which is said", async () => {
  const { store, selecting, said } = await looking();
  store.set({ selection: new Uint8Array([1, 0, 0, 1, 0]) });
  selecting.gesture("lasso", new Uint8Array([0, 1, 1, 0, 1]), "add");
  assert.deepEqual([...store.state.selection], [1, 1, 0, 1, 0]);
  assert.match(store.state.notice?.text ?? "", /^2 detections that the question isn't about/);
  selecting.choose(1);
  await turn();
  assert.deepEqual(said[0].points, FIRST.points);
});

test("a kind that somebody doesn't wait for is not looked at elsewhere, and one that can't be read is passed over", async () => {
  const table = new Table();
  const show = table.picture.bind(table);
  table.picture = (): void => table.store.set({ cloud: buildCloud([made("rear", 3, { x: [1] })]) });
  await table.kinding.next();
  await table.kinding.next();
  const told = (): string | undefined => table.store.state.kind?.kind;
  assert.equal(told(), undefined);
  table.picture = show;
  await table.kinding.next();
  assert.equal(told(), SECOND.kind);
});

test("while a kind is looked at nothing is flipped by mistake", async () => {
  const { store, selecting, said } = await looking();
  selecting.flip();
  await turn();
  assert.equal(store.state.kind?.kind, FIRST.kind);
  assert.deepEqual(said, []);
});
