import assert from "node:assert/strict";
import { test } from "node:test";
import { Imagery } from "../../src/actions/imagery.js";
import type { World } from "../../src/actions/world.js";
import type { Column, Table } from "../../src/api/table.js";
import { type CameraMoment, withoutPlaces } from "../../src/data/camera-moment.js";
import { buildCloud } from "../../src/data/cloud.js";
import { heldStill, letGo } from "../../src/data/held.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

const CLOUD = buildCloud([made("front", 0, { x: [1, 2] })]);
const INFO = { name: "ahead", width: 40, height: 20, images: ["0"] };
const CAMERA: CameraMoment = {
  info: INFO,
  image: 0,
  failed: false,
  picture: null,
  problem: null,
  places: withoutPlaces(CLOUD.count),
  lidar: null,
};

function projected(): Table<object> {
  const columns = new Map<string, Column>([
    ["u", new Float32Array([10, 20])],
    ["v", new Float32Array([11, 21])],
  ]);
  return { rows: 2, infos: [], header: {}, columns };
}

/** A page whose camera answers when it's told to. */
function waiting(): { readonly store: Store<State>; readonly imagery: Imagery; readonly answer: () => void } {
  const store = new Store<State>(initialState(recordingOf([sequence("00")]), "ada"));
  let answer = (): void => undefined;
  const come = new Promise<void>((resolve) => (answer = resolve));
  const loader = {
    image: () => come.then(() => "picture"),
    projections: () => come.then(projected),
  };
  const imagery = new Imagery({ store, loader } as unknown as World);
  store.set({ sequence: "00", cloud: CLOUD, cameras: [CAMERA] });
  return { store, imagery, answer };
}

test("what cameras answer while something is held still, or let go, is shown", async () => {
  const held = heldStill(CLOUD, new Uint8Array([1, 0]));
  for (const clouds of [[CLOUD], [held], [held, letGo(held)]]) {
    const { store, imagery, answer } = waiting();
    const complete = imagery.complete(CLOUD, CAMERA);
    for (const cloud of clouds) store.set({ cloud });
    answer();
    await complete;
    const [{ picture, places }] = store.state.cameras;
    assert.deepEqual([picture, [...places]], ["picture", [10, 11, 20, 21]]);
  }
});

test("what cameras answer of another scan is left out", async () => {
  const { store, imagery, answer } = waiting();
  const complete = imagery.complete(CLOUD, CAMERA);
  store.set({ cloud: buildCloud([made("front", 1, { x: [1, 2] })]) });
  answer();
  await complete;
  assert.equal(store.state.cameras[0].picture, null);
});
