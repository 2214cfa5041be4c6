import assert from "node:assert/strict";
import { test } from "node:test";
import type { Adopting } from "../../src/actions/adopting.js";
import { Correcting } from "../../src/actions/correcting.js";
import type { Kinding } from "../../src/actions/kinding.js";
import type { Navigation } from "../../src/actions/navigation.js";
import { Opining } from "../../src/actions/opining.js";
import { Ruling } from "../../src/actions/ruling.js";
import { Selecting } from "../../src/actions/selecting.js";
import { Settling } from "../../src/actions/settling.js";
import type { Thinging } from "../../src/actions/thinging.js";
import type { World } from "../../src/actions/world.js";
import type {
  BaseRevision,
  Disagreement,
  ScanId,
  ScanPoints,
  StrokeAnswer,
  StrokeRequest,
} from "../../src/api/types.js";
import { buildCloud, type Cloud, withScans } from "../../src/data/cloud.js";
import { everything } from "../../src/data/filter.js";
import { rulesText } from "../../src/data/rules.js";
import { sameScan } from "../../src/data/scan.js";
import { outlookOf } from "../../src/data/team.js";
import { deriveAlways } from "../../src/derive.js";
import { initialState, lookedAt, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { nearOf } from "../../src/viewer/marks.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

const HERE = { radar: "front", scan: 0 };
const [THIS, NEXT] = [made("front", 0, { x: [1, 2, 3] }), made("front", 1, { x: [4, 5] })];
const [ALONE, WHOLE] = [buildCloud([THIS]), buildCloud([THIS, NEXT])];
const front = (scan: number, ...points: number[]): ScanPoints => ({ radar: "front", scan, points });

function disagreement(thing: number, points: readonly ScanPoints[]): Disagreement {
  const counts = { detections: 9, scans: 2, plausible: 9, answered: 0, expected_errors: 1 };
  return {
    ...{ first_cause: null, second_cause: null },
    thing,
    first: 1,
    second: 99,
    by: "bob",
    points,
    ...counts,
    place: [0, 0, 0],
    radius: 1,
    ...HERE,
    point: 0,
  };
}

/** The last of it is in a scan that is never on screen. */
const DISPUTED = disagreement(1, [front(0, 0, 1), front(1, 0), front(9, 4)]);
const RULE = { name: "ghosts", filter: everything, sets: { label: 1, cause: null } };

/** A page without a picture: what settles is noted, and every scan is there at once. */
class Table {
  readonly store = new Store<State>(initialState(recordingOf([sequence("00", "ada")]), "ada"));
  readonly settled: (readonly ScanPoints[])[] = [];
  readonly world: World;
  readonly settling: Settling;
  readonly selecting: Selecting;
  readonly ruling: Ruling;
  readonly opining: Opining;

  constructor() {
    const { store } = this;
    deriveAlways(store);
    const api = {
      disagreements: () => Promise.resolve({ people: [], waiting: null, changes: [DISPUTED], base: [] }),
      opinion: () => Promise.resolve({ answered: 0, scans: null, changes: [], base: [] }),
    };
    const world = (this.world = { store, api } as unknown as World);
    const go = { wholeSequence: (at: ScanId) => Promise.resolve(this.goTo(at)) } as unknown as Navigation;
    const settle = (points: readonly ScanPoints[]): Promise<boolean> => {
      this.settled.push(points);
      return Promise.resolve(false);
    };
    const correct = { settle, free: () => Promise.resolve(true) } as unknown as Correcting;
    this.settling = new Settling(world, go, correct);
    this.selecting = new Selecting(world, correct, {} as Thinging, this.settling, {} as Kinding);
    this.ruling = new Ruling(world, go, this.selecting, correct);
    this.opining = new Opining(world, go, correct);
    store.set({ sequence: "00", current: HERE, loading: false, cloud: ALONE, scope: "shown" });
  }

  /** Nothing is fetched anew where it is on screen. */
  private goTo(at: ScanId): void {
    const { cloud, current } = this.store.state;
    if (cloud.scans !== WHOLE.scans || !sameScan(current, at)) this.arrive(at);
  }

  arrive({ radar, scan }: ScanId): void {
    this.store.set({ current: { radar, scan } });
    this.picture(WHOLE);
  }

  /** Other scans of the same moment come on screen, as with Z. */
  picture(cloud: Cloud): void {
    this.store.set({ cloud, selection: new Uint8Array(cloud.count) });
  }
}

/** With a disagreement on screen. */
async function looking(): Promise<Table> {
  const table = new Table();
  await table.settling.next();
  assert.deepEqual([...table.store.state.selection], [1, 1, 0, 1, 0]);
  return table;
}

/** A browser's storage that holds a rule. */
function keepingRule(): void {
  const kept = { getItem: () => rulesText([RULE]), setItem: () => undefined };
  Object.defineProperty(globalThis, "localStorage", { value: kept, configurable: true });
}
keepingRule();

test("a side is taken of what is selected, and of what isn't on screen", async () => {
  const { store, settling, settled } = await looking();
  store.set({ selection: new Uint8Array([1, 0, 0, 1, 0]) });
  settling.take("first");
  assert.deepEqual(settled, [[front(0, 0), front(1, 0), front(9, 4)]]);
});

test("whoever puts other scans on screen settles nothing, for what was spared isn't seen any more", async () => {
  const table = await looking();
  table.picture(ALONE);
  assert.equal(table.store.state.disputed, null);
  assert.match(table.store.state.notice?.text ?? "", /disagreement is left/);
  for (const side of ["first", "second"] as const) table.settling.take(side);
  assert.deepEqual(table.settled, []);
});

test("the same scans with other labels are still the same picture", async () => {
  const { store, settling, settled } = await looking();
  store.set({ cloud: withScans(WHOLE, [{ ...THIS, label: THIS.label.map(() => 1) }]) });
  assert.equal(store.state.disputed, DISPUTED);
  settling.take("second");
  assert.equal(settled.length, 1);
});

/** Lets plausible ones through that are no farther than this, m. */
const within = (most: number) => ({ ...everything, range: [0, most] as const });

test("what the filter hides of it is left, which is said, and is selected again once it is shown", async () => {
  const { store, settling, settled } = await looking();
  store.set({ filter: within(3) });
  assert.deepEqual([...store.state.selection], [1, 1, 0, 0, 0]);
  assert.deepEqual(outlookOf(DISPUTED, store.state), { all: 4, settled: 3, elsewhere: 1, unshown: 1, unreached: 0 });
  settling.showAll();
  assert.deepEqual([...store.state.selection], [1, 1, 0, 1, 0]);
  store.set({ filter: within(3), scope: "scan" });
  settling.take("first");
  await Promise.resolve();
  assert.deepEqual(settled, [[front(0, 0, 1), front(9, 4)]]);
});

test("what was spared by hand stays spared, however often the filter hides and shows it", async () => {
  const { store, settling, settled } = await looking();
  store.set({ selection: new Uint8Array([0, 1, 0, 1, 0]) });
  for (const filter of [within(1), within(3), everything]) store.set({ filter });
  assert.deepEqual([...store.state.selection], [0, 1, 0, 1, 0]);
  settling.take("first");
  assert.deepEqual(settled, [[front(0, 1), front(1, 0), front(9, 4)]]);
});

test("a disagreement that is hidden when it comes is selected once it is shown", async () => {
  const table = new Table();
  table.store.set({ filter: { ...everything, plausible: false } });
  await table.settling.next();
  assert.deepEqual([...table.store.state.selection], [0, 0, 0, 0, 0]);
  assert.equal(outlookOf(DISPUTED, table.store.state).unshown, 3);
  table.settling.showAll();
  assert.deepEqual([...table.store.state.selection], [1, 1, 0, 1, 0]);
});

test("beside a disagreement everything else is faint, as beside a question", async () => {
  const { store } = await looking();
  assert.deepEqual([...nearOf(store.state)], [1, 1, 0, 1, 0]);
  store.set({ disputed: null });
  assert.deepEqual([...nearOf(store.state)], [1, 1, 1, 1, 1]);
});

test("a disagreement is what is looked at, as a thing is", async () => {
  const { store } = await looking();
  assert.equal(lookedAt(store.state), DISPUTED);
});

test("where nothing of it is selected, that is said and nothing is settled", async () => {
  const table = new Table();
  const near = disagreement(2, [front(0, 0)]);
  await table.settling.next();
  table.store.set({ disputed: near, filter: { ...everything, plausible: false } });
  table.settling.take("first");
  assert.deepEqual(table.settled, []);
  assert.match(table.store.state.notice?.text ?? "", /nothing is settled/);
});

test("who goes elsewhere while the next disagreement is fetched doesn't get it", async () => {
  const table = new Table();
  table.arrive = () => table.store.set({ current: { radar: "rear", scan: 3 }, loading: true });
  await table.settling.next();
  assert.equal(table.store.state.disputed, null);
});

test("a side is taken once, however long the server takes and however often a key is pressed", async () => {
  const { store } = await looking();
  const sent: StrokeRequest[] = [];
  const stroke = (_: string, asked: StrokeRequest): Promise<StrokeAnswer> => {
    sent.push(asked);
    return new Promise(() => undefined);
  };
  const world = { store, api: { stroke } } as unknown as World;
  const keeper = { found: [], keep: () => Promise.resolve() };
  const correct = new Correcting(world, {} as Navigation, {} as Adopting, keeper);
  const settling = new Settling(world, {} as Navigation, correct);
  store.set({ disagreements: { people: [], waiting: null, changes: [DISPUTED], base: [] } });
  store.set({ disputed: DISPUTED, selection: new Uint8Array([1, 1, 0, 1, 0]) });
  for (const side of ["second", "second", "first"] as const) settling.take(side);
  assert.deepEqual(
    sent.map(({ label, points }) => [label, points]),
    [[99, DISPUTED.points]],
  );
  assert.equal(store.state.waiting.length, 1);
});

test("the cause that a side has said goes with it, and none with another answer", async () => {
  const table = await looking();
  const causes: (string | null)[] = [];
  const settle = (
    ...[, , , cause = null]: readonly [unknown, unknown, unknown, (string | null)?]
  ): Promise<boolean> => {
    causes.push(cause);
    return Promise.resolve(false);
  };
  const settling = new Settling(table.world, {} as Navigation, { settle } as unknown as Correcting);
  const selection = new Uint8Array([1, 1, 0, 1, 0]);
  const disagreements = { people: [], waiting: null, changes: [], base: [] };
  table.store.set({ disagreements, disputed: { ...DISPUTED, first_cause: "mirror" }, selection });
  settling.take("first");
  settling.take("second");
  settling.answer(1);
  assert.deepEqual(causes, ["mirror", null, null]);
});

test("asking for a proposal empties the selection, and ends the disagreement", async () => {
  const { store, opining, settling, settled } = await looking();
  await opining.askOrAccept();
  assert.equal(store.state.disputed, null);
  settling.take("second");
  assert.deepEqual(settled, []);
});

test("a rule that is chosen ends the disagreement, and a disagreement ends the rule", async () => {
  const { store, ruling, settling } = await looking();
  await ruling.choose("ghosts");
  assert.deepEqual([store.state.rule?.name, store.state.disputed], ["ghosts", null]);
  await settling.next();
  assert.deepEqual([store.state.rule, store.state.disputed], [null, DISPUTED]);
});

test("a rule chooses in the scans on screen, and is gone with them", async () => {
  for (const cloud of [ALONE, buildCloud([]), buildCloud([NEXT, THIS])]) {
    const table = new Table();
    await table.ruling.choose("ghosts");
    table.store.set({ cloud: withScans(WHOLE, [THIS]) });
    assert.notEqual(table.store.state.rule, null);
    table.picture(cloud);
    assert.equal(table.store.state.rule, null);
  }
});

test("a side rests on what was said when the disagreement came on screen, whatever is read of it since", async () => {
  const table = await looking();
  const bases: (readonly BaseRevision[])[] = [];
  const settle = (_: unknown, base: readonly BaseRevision[]): Promise<boolean> => {
    bases.push(base);
    return Promise.resolve(false);
  };
  const read = (revision: number) => ({
    people: [],
    waiting: null,
    changes: [DISPUTED],
    base: [{ ...HERE, revision }],
  });
  const answers = [read(1), read(2)];
  const api = { disagreements: () => Promise.resolve(answers.shift()), people: () => Promise.resolve({ days: [] }) };
  const go = { wholeSequence: () => Promise.resolve() } as unknown as Navigation;
  const world = { store: table.store, api } as unknown as World;
  const settling = new Settling(world, go, { settle } as unknown as Correcting);
  await settling.next();
  await settling.open();
  settling.take("first");
  assert.deepEqual(bases, [[{ ...HERE, revision: 1 }]]);
});
