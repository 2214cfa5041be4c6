import assert from "node:assert/strict";
import { test } from "node:test";
import { closed, firstAddress, nameAmong } from "../../src/actions/starting.js";
import type { Progress } from "../../src/api/types.js";
import { initialState } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";

const SEQUENCES = [sequence("raw", "bob", false), sequence("00", "ada"), sequence("01", "bob"), sequence("02", "cem")];

/** How far each sequence is: scans, and how many are reviewed. What isn't named can't be read. */
function progressOf(known: Readonly<Record<string, readonly [number, number]>>): (name: string) => Promise<Progress> {
  return (name) => {
    if (known[name] === undefined) return Promise.reject(new Error(`${name} can't be read`));
    const [scans, reviewed] = known[name];
    return Promise.resolve({ scans, reviewed, corrected_detections: 0, orphaned_scans: 0 });
  };
}

const unasked = (): Promise<Progress> => Promise.reject(new Error("nobody needs to know"));

async function first(person: string, hash = ""): Promise<string | undefined> {
  return (await firstAddress(recordingOf(SEQUENCES), person, hash, unasked))?.sequence;
}

test("a person begins at a labelled sequence of its own, else at the first one that is labelled", async () => {
  assert.deepEqual(await Promise.all([first("bob"), first("cem"), first("zoe")]), ["01", "02", "00"]);
  assert.equal(await first("bob", "#02/front/7"), "02", "an address says where");
  assert.equal(await first("bob", "#elsewhere"), "01", "an address of another recording doesn't");
  assert.equal(await firstAddress(recordingOf([]), "bob", "", unasked), null);
  assert.equal((await firstAddress(recordingOf([SEQUENCES[0]]), "bob", "", unasked))?.sequence, "raw");
});

test("who labels a second time begins where something was dealt, which is never a sequence of its own", async () => {
  const second = async (known: Readonly<Record<string, readonly [number, number]>>): Promise<string | undefined> =>
    (await firstAddress(recordingOf(SEQUENCES, "bob"), "bob", "", progressOf(known)))?.sequence;
  assert.equal(await second({ "00": [0, 0], "01": [0, 0], "02": [3, 0] }), "02");
  assert.equal(await second({ "00": [3, 3], "01": [0, 0], "02": [3, 1] }), "02", "what is done can wait");
  assert.equal(await second({ "00": [0, 0], "01": [3, 3], "02": [2, 2] }), "01", "all of it is done");
  assert.equal(await second({ "00": [0, 0], "01": [0, 0], "02": [0, 0] }), "00", "nothing was dealt");
  assert.equal(await second({ "02": [3, 0] }), "02", "others that can't be read don't stop anybody");
});

test("what waits for a dialog goes on once it is closed, whatever was said", async () => {
  const store = new Store(initialState(recordingOf(SEQUENCES), "ada"));
  await closed(store, "name");
  store.set({ dialog: "name" });
  let opened = false;
  const waiting = closed(store, "name").then(() => (opened = true));
  store.set({ name: "bob" });
  await Promise.resolve();
  assert.equal(opened, false);
  store.set({ dialog: "none" });
  await waiting;
  assert.equal(opened, true);
});

test("names that differ by case alone are one person's", () => {
  assert.deepEqual(
    ["Ada", "ada", "Zoë"].map((name) => nameAmong(["ada", "bob"], name)),
    ["ada", "ada", "Zoë"],
  );
});
