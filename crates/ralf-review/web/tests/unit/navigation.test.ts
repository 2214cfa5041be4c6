import assert from "node:assert/strict";
import { test } from "node:test";
import type { Moment } from "../../src/actions/moment.js";
import { Navigation } from "../../src/actions/navigation.js";
import type { World } from "../../src/actions/world.js";
import type { ScanId } from "../../src/api/types.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";

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

test("a scan is there before its cameras' pictures: what is selected then doesn't take the place of a later choice", async () => {
  const store = new Store<State>(initialState(recordingOf([sequence("00", "ada")]), "ada"));
  const shown: ScanId[] = [];
  const show = (id: ScanId): Promise<void> => {
    shown.push(id);
    store.set({ current: id });
    return Promise.resolve();
  };
  const moment = { show, pictured: () => new Promise(() => undefined) } as unknown as Moment;
  Object.assign(globalThis, { window: { history: { replaceState: () => undefined } } });
  await new Navigation({ store } as unknown as World, moment).goTo({ radar: "front", scan: 4 });
  assert.deepEqual(shown, [{ radar: "front", scan: 4 }]);
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
