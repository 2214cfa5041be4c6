import assert from "node:assert/strict";
import { test } from "node:test";
import type { Adopting } from "../../src/actions/adopting.js";
import type { Navigation } from "../../src/actions/navigation.js";
import type { Correcting } from "../../src/actions/correcting.js";
import type { Kinding } from "../../src/actions/kinding.js";
import { Relabelling } from "../../src/actions/relabelling.js";
import { Selecting } from "../../src/actions/selecting.js";
import type { Settling } from "../../src/actions/settling.js";
import { Thinging } from "../../src/actions/thinging.js";
import type { World } from "../../src/actions/world.js";
import type { Table } from "../../src/api/table.js";
import type { DoubtfulThing, ThingsHeader } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { everything } from "../../src/data/filter.js";
import { deriveAlways } from "../../src/derive.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

const GROUND = { bit: 1, name: "ground", decided: true };

/** A page on a scan of three detections, of a first run, and a server of whatever run a test says. */
class Desk {
  run = "first";
  readonly store = new Store<State>(initialState({ ...recordingOf([sequence("00")]), flags: [GROUND] }, "ada"));
  readonly world: World;

  constructor() {
    const header = (): ThingsHeader => ({
      run: this.run,
      scans: [{ radar: "front", scan: 0, rows: 3 }],
      // Thing 1 is at another place, and of other detections, in each run.
      doubtful: [doubtful(1, this.run === "first" ? 0 : 100)],
      things: 2,
      expected_errors: 1,
    });
    const things = (): Table<ThingsHeader> => {
      const thing = new Uint32Array(this.run === "first" ? [0, 1, 1] : [1, 0, 0]);
      return { rows: 3, infos: [], header: header(), columns: new Map([["thing", thing]]) };
    };
    const api = {
      recording: () => Promise.resolve({ ...this.store.state.recording, threshold: this.run === "first" ? 0.5 : 0.7 }),
      things: () => Promise.resolve(things()),
      doubtful: () => Promise.resolve(header()),
    };
    this.world = { store: this.store, api } as unknown as World;
    deriveAlways(this.store);
    this.store.set({ sequence: "00", current: { radar: "front", scan: 0 }, loading: false });
    this.show();
  }

  /** The scan as it is now. */
  show(): void {
    const scan = made("front", 0, { x: [1, 2, 3], w: [0.5, 0.9, 0.7], run: this.run });
    this.store.set({ cloud: buildCloud([scan]) });
  }
}

function doubtful(thing: number, x: number): DoubtfulThing {
  const counts = { detections: 2, scans: 1, plausible: 1, answered: 0, expected_errors: 1 };
  return { thing, place: [x, 0, 0], radius: 1, ...counts, radar: "front", scan: 0, point: 0 };
}

test("once the scan on screen is of another run, so is the threshold, and what is uncertain by it", async () => {
  const desk = new Desk();
  new Relabelling(desk.world);
  desk.store.set({ filter: { ...everything, uncertain: true } });
  assert.deepEqual([...desk.store.state.shown], [1, 0, 0]);
  desk.run = "second";
  desk.show();
  await new Promise((resolve) => setTimeout(resolve));
  assert.equal(desk.store.state.recording.threshold, 0.7);
  assert.deepEqual([...desk.store.state.shown], [0, 0, 1]);
});

test("after somebody labelled again the next thing is one of the new labels, and so is what is selected", async () => {
  const desk = new Desk();
  const adopting = { readAllAnew: () => Promise.resolve(desk.show()) } as unknown as Adopting;
  const navigation = { wholeSequence: () => Promise.resolve() } as unknown as Navigation;
  const thinging = new Thinging(desk.world, navigation, adopting);
  const next = async (): Promise<readonly number[]> => {
    await thinging.next();
    return [...desk.store.state.selection];
  };
  assert.deepEqual(await next(), [0, 1, 1]);
  desk.run = "second";
  assert.deepEqual(await next(), [1, 0, 0]);
  desk.run = "third";
  const chosen = new Uint8Array([1, 0, 0]);
  desk.show();
  assert.equal(thinging.whole(chosen), chosen, "what belongs together in these labels isn't known yet");
});

test("a thing whose scans can't be read, or that the filter hides, is told and passed over", async () => {
  const desk = new Desk();
  const more = { run: "first", doubtful: [doubtful(1, 0), doubtful(0, 500)] };
  Object.assign(desk.world.api, { doubtful: () => Promise.resolve(more) });
  const read = { wholeSequence: () => Promise.resolve(desk.store.set({ loading: true })) };
  const things = new Thinging(desk.world, read as unknown as Navigation, {} as Adopting);
  await things.next();
  read.wholeSequence = () =>
    Promise.resolve(desk.store.set({ loading: false, filter: { ...everything, range: [9, 10] } }));
  await things.next();
  assert.match(desk.store.state.notice?.text ?? "", /filter hides all/);
  await things.next();
  assert.match(desk.store.state.notice?.text ?? "", /Every doubtful thing/);
  assert.equal(desk.store.state.thing, null);
});

test("what somebody selects while the next thing is asked for stays selected, and that is said", async () => {
  const { store, world } = new Desk();
  const navigation = { wholeSequence: () => Promise.resolve() } as unknown as Navigation;
  const things = new Thinging(world, navigation, {} as Adopting);
  const asked = things.next();
  store.set({ selection: new Uint8Array([1, 0, 0]) });
  await asked;
  assert.deepEqual([[...store.state.selection], store.state.thing], [[1, 0, 0], null]);
  assert.match(store.state.notice?.text ?? "", /you are at something/);
});

test("of a thing that comes what the filter hides isn't selected: nobody would see what is said of it", async () => {
  const desk = new Desk();
  desk.store.set({ filter: { ...everything, range: [0, 2] } });
  await new Thinging(
    desk.world,
    { wholeSequence: () => Promise.resolve() } as unknown as Navigation,
    {} as Adopting,
  ).next();
  assert.deepEqual([...desk.store.state.selection], [0, 1, 0]);
});

test("a key that is pressed again before the next thing is there says nothing and begins no painting", async () => {
  const { store, world } = new Desk();
  const more = { run: "first", doubtful: [doubtful(1, 0), doubtful(0, 500)] };
  Object.assign(world.api, { doubtful: () => Promise.resolve(more) });
  let arrive: () => void = () => undefined;
  const navigation = { wholeSequence: () => new Promise<void>((resolve) => (arrive = resolve)) };
  const things = new Thinging(world, navigation as unknown as Navigation, {} as Adopting);
  const said: (readonly number[])[] = [];
  const apply = (): Promise<void> => {
    said.push([...store.state.selection]);
    store.set({ selection: new Uint8Array(3) });
    return Promise.resolve();
  };
  const correct = { apply } as unknown as Correcting;
  const selecting = new Selecting(world, correct, things, {} as Settling, {} as Kinding);
  const turn = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));
  const asked = things.next();
  await turn();
  selecting.choose(1);
  arrive();
  await asked;
  for (const _ of [1, 2, 3]) {
    selecting.choose(1);
    await turn();
  }
  assert.deepEqual([said, store.state.armed, things.coming], [[[0, 1, 1]], undefined, true]);
});

test("a thing whose sequence is left while its scans are read is not looked for in another one", async () => {
  const desk = new Desk();
  const chosen = new Uint8Array(3);
  const wholeSequence = (): Promise<void> =>
    Promise.resolve(desk.store.set({ sequence: "01", selection: chosen, thing: null }));
  const navigation = { wholeSequence } as unknown as Navigation;
  await new Thinging(desk.world, navigation, {} as Adopting).next();
  assert.deepEqual([desk.store.state.selection, desk.store.state.thing], [chosen, null]);
});
