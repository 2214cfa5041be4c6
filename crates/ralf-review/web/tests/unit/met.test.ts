import assert from "node:assert/strict";
import { test } from "node:test";
import type { Adopting } from "../../src/actions/adopting.js";
import { Correcting } from "../../src/actions/correcting.js";
import type { Navigation } from "../../src/actions/navigation.js";
import type { World } from "../../src/actions/world.js";
import { Conflict } from "../../src/api/errors.js";
import type { ScanId } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { isShown, toldOf } from "../../src/history/met.js";
import type { Met } from "../../src/history/outbox.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

/** The same radar and scan in every sequence. */
const HERE = { radar: "front", scan: 0 };
const CLOUD = buildCloud([made("front", 0, { x: [1, 2, 3] })]);

/** A page on sequence 01 on which a stroke in sequence 00 is in conflict. */
async function met(stale = false): Promise<{ readonly store: Store<State>; readonly correct: Correcting }> {
  const store = new Store<State>(initialState(recordingOf([sequence("00"), sequence("01")]), "ada"));
  store.set({ sequence: "01", cloud: CLOUD, selection: new Uint8Array(3) });
  const open = (name: string, at: ScanId): Promise<void> => {
    store.set({ sequence: name, current: at, cloud: CLOUD, selection: new Uint8Array(3) });
    return Promise.resolve();
  };
  const conflict = stale ? null : { author: "bob", at: "?", tool: "lasso", ...HERE };
  const scans = stale ? [] : [{ ...HERE, revision: 1, corrections: [[1, 99]] as const, causes: [], reviewed: null }];
  const refused = new Conflict({ error: "changed", stale, conflict, scans });
  const world = { store, api: { stroke: () => Promise.reject(refused) } } as unknown as World;
  const adopting = { adopt: () => Promise.resolve(), readAllAnew: () => Promise.resolve() } as unknown as Adopting;
  const keeper = { found: [], keep: () => Promise.resolve() };
  const correct = new Correcting(world, { open } as unknown as Navigation, adopting, keeper);
  const part = { sequence: "00", base: [{ ...HERE, revision: 0 }], points: [{ ...HERE, points: [0, 1] }] };
  await correct.replay([{ ...part, detections: 2, already: 0, spared: 0, problem: null }], {
    label: 1,
    cause: null,
  });
  return { store, correct };
}

test("a conflict in a sequence that isn't on screen names it, and the picture is said to show it once it does", async () => {
  const { store, correct } = await met();
  const conflict = store.state.outbox as Met;
  assert.deepEqual(toldOf(conflict, store.state), [
    "bob changed front 0 in sequence 00 with lasso, ?.",
    "Your rule sets 2 detections in sequence 00 to artifact. Nothing of it is saved yet.",
    "“Show it” puts on screen the newer state, with your detections selected; 1 of them is corrected there.",
  ]);
  store.set({ selection: new Uint8Array([1, 1, 0]) });
  assert.equal(isShown(conflict, store.state), false, "these are detections of another sequence");
  await correct.showMet();
  assert.deepEqual([store.state.sequence, [...store.state.selection]], ["00", [1, 1, 0]]);
  assert.deepEqual(toldOf(conflict, store.state), [
    "bob changed front 0 with lasso, ?.",
    "Your rule sets 2 detections to artifact. Nothing of it is saved yet.",
    "The picture shows the newer state, with your detections selected; 1 of them is corrected there.",
  ]);
  store.set({ selection: new Uint8Array(3) });
  assert.equal(isShown(conflict, store.state), false);
});

test("a stroke on detections that aren't there any more names its sequence, too", async () => {
  const { store } = await met(true);
  assert.deepEqual(toldOf(store.state.outbox as Met, store.state), [
    "changed",
    "Your stroke in sequence 00 was made on what was there before. Nothing of it is saved.",
  ]);
});
