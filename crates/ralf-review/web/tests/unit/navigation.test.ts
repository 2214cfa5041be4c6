import assert from "node:assert/strict";
import { test } from "node:test";
import { Moment } from "../../src/actions/moment.js";
import { Navigation } from "../../src/actions/navigation.js";
import type { World } from "../../src/actions/world.js";
import { buildCloud } from "../../src/data/cloud.js";
import { initialState, isOnScreen, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

test("a sequence whose answer comes after a later choice doesn't take its place", async () => {
  const store = new Store<State>(initialState(recordingOf([sequence("00", "ada"), sequence("01", "ada")]), "ada"));
  const answers = new Map<string, (queue: object) => void>();
  const api = {
    queue: (name: string) => new Promise((answer) => answers.set(name, answer)),
    history: () => Promise.resolve(store.state.history),
  };
  let forgotten = 0;
  const loader = { forgetScans: () => (forgotten += 1) };
  const go = new Navigation({ store, api, loader } as unknown as World, {} as Moment);
  const opening = ["00", "01"].map((name) => go.open(name));
  for (const name of ["01", "00"]) {
    answers.get(name)?.({ scans: [], progress: store.state.progress });
    await Promise.all(name === "00" ? opening : [opening[1]]);
    assert.equal(store.state.sequence, "01");
  }
  assert.equal(forgotten, 1, "of a sequence that was not on screen nobody told what others changed");
});

/** A page with a scan that a camera sees whose image never comes. */
function beside(camera: string): { readonly store: Store<State>; readonly go: Navigation } {
  const cameras = [{ name: camera, width: 40, height: 20, images: ["0"] }];
  const recording = recordingOf([{ ...sequence("00", "ada"), cameras }]);
  const store = new Store<State>({ ...initialState(recording, "ada"), sequence: "00" });
  const { table, ...scan } = made("front", 4, { x: [1, 2] });
  const seen = {
    ...scan,
    table: { ...table, header: { ...table.header, cameras: [{ name: camera, image: 0, t_ns: "0" }] } },
  };
  const never = (): Promise<never> => new Promise(() => undefined);
  const loader = {
    around: () => Promise.resolve([{ radar: "front", scan: 4 }]),
    scan: () => Promise.resolve(seen),
    lidar: () => Promise.resolve(null),
    cloud: () => Promise.resolve(buildCloud([seen])),
    image: never,
    projections: never,
  };
  const world = { store, loader } as unknown as World;
  Object.assign(globalThis, { window: { history: { replaceState: () => undefined } } });
  return { store, go: new Navigation(world, new Moment(world)) };
}

test("a scan is there before its cameras' pictures: nothing is selected between it and what is looked at", async () => {
  const { store, go } = beside("ahead");
  await go.goTo({ radar: "front", scan: 4 });
  assert.deepEqual([isOnScreen(store.state, { radar: "front", scan: 4 }), store.state.cameras.length], [true, 1]);
});

test("a scan that is on its way is not there yet", async () => {
  const { store, go } = beside("ahead");
  const coming = go.wholeSequence({ radar: "front", scan: 4 });
  assert.deepEqual(store.state.current, { radar: "front", scan: 4 });
  assert.equal(isOnScreen(store.state, { radar: "front", scan: 4 }), false);
  await coming;
  assert.equal(isOnScreen(store.state, { radar: "front", scan: 4 }), true);
});

test("who has gone through one radar is told of that radar, for others may be left", async () => {
  const store = new Store<State>(initialState(recordingOf([sequence("00", "ada")]), "ada"));
  const go = new Navigation({ store } as unknown as World, {} as Moment);
  await go.nextNeedy();
  assert.match(store.state.notice?.text ?? "", /Every scan of this sequence/);
  go.viewQueue({ radar: "rear" });
  await go.nextNeedy();
  assert.match(store.state.notice?.text ?? "", /Every scan of rear in this sequence/);
});
