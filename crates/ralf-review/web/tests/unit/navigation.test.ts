import assert from "node:assert/strict";
import { test } from "node:test";
import type { Moment } from "../../src/actions/moment.js";
import { Navigation } from "../../src/actions/navigation.js";
import type { World } from "../../src/actions/world.js";
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
