import assert from "node:assert/strict";
import { test } from "node:test";
import { addressFrom, addressText } from "../../src/actions/address.js";
import { Cache } from "../../src/data/cache.js";
import { everything } from "../../src/data/filter.js";
import { LabelBook, searchClasses } from "../../src/data/labels.js";
import { clock, counted, decimal, secondsBetween } from "../../src/format.js";
import { keyName, shownKey } from "../../src/panels/keys.js";
import { read, writtenPreferences } from "../../src/preferences.js";
import { Store } from "../../src/store.js";

const CLASSES = [
  { id: 1, name: "outlier", cluster: "artifact", plausible: false },
  { id: 10, name: "car", cluster: "vehicle", plausible: true },
  { id: 40, name: "road", cluster: "artifact", plausible: false },
  { id: 252, name: "moving-car", cluster: "vehicle", plausible: true },
];

test("watchers hear of what they watch, once, and see the newest", () => {
  const store = new Store({ a: 1, b: 1, sum: 0 });
  const sums: number[] = [];
  store.watch(
    ({ a, b }) => [a, b],
    (a, b) => store.set({ sum: a + b }),
  );
  store.watch(
    ({ sum }) => [sum],
    (sum) => sums.push(sum),
  );
  store.set({ a: 2 });
  store.set({ a: 2 });
  assert.deepEqual(sums, [2, 3]);
});

test("a watcher that was ended hears nothing", () => {
  const store = new Store({ a: 1 });
  let heard = 0;
  store.watch(
    ({ a }) => [a],
    () => (heard += 1),
  )();
  store.set({ a: 2 });
  assert.equal(heard, 1);
});

test("addresses come back as they were, whatever the names", () => {
  const address = { sequence: "a/b c", scan: { radar: "radär#1", scan: 17 } };
  assert.deepEqual(addressFrom(addressText(address)), address);
  assert.deepEqual(addressFrom("#00"), { sequence: "00", scan: null });
  assert.deepEqual(addressFrom("#00/front/x"), { sequence: "00", scan: null });
  assert.equal(addressFrom(""), null);
  assert.deepEqual(addressFrom("#%"), { sequence: "%", scan: null }, "an address that nobody encoded stops nothing");
});

test("preferences come back as they were, and nonsense changes nothing", () => {
  const queueView = { order: "need", hideReviewed: false, radar: null } as const;
  const now = {
    colour: "label",
    filter: everything,
    lidarShown: true,
    groundHidden: true,
    lidarInImages: false,
    light: false,
    dotSize: 8,
    queueView,
  };
  const filter = { ...everything, range: [0, 30] as const, hiddenRadars: new Set(["rear"]), uncertain: true };
  const changed = {
    ...now,
    colour: "column w",
    filter,
    light: true,
    lidarInImages: true,
    dotSize: 12,
    queueView: { ...queueView, order: "time" } as const,
  };
  assert.deepEqual(read(writtenPreferences(changed), now), changed);
  assert.deepEqual(read(null, now), {});
  for (const nonsense of ["", "{", "7", "null"]) assert.deepEqual(read(nonsense, now), {});
  const odd = read('{"colour": 7, "dotSize": "x", "filter": {"score": "no", "origin": "who"}, "queueView": 3}', now);
  assert.deepEqual(odd, { filter: everything, queueView });
});

test("a cache forgets the oldest, and what failed", async () => {
  const cache = new Cache<number>(2);
  const read = (value: number) => (): Promise<number> => Promise.resolve(value);
  await cache.get("a", read(1));
  await cache.get("b", read(2));
  assert.equal(await cache.get("a", read(9)), 1);
  await cache.get("c", read(3));
  assert.equal(await cache.get("a", read(9)), 1);
  assert.equal(await cache.get("b", read(9)), 9);
  await assert.rejects(cache.get("d", () => Promise.reject(new Error("no"))));
  assert.equal(await cache.get("d", read(4)), 4);
});

test("labels mean what SemanticKITTI and the paper say", () => {
  const labels = new LabelBook(CLASSES);
  assert.deepEqual(
    [0, 1, 40, 10, 99, 4711].map((id) => labels.truth(id)),
    ["unlabelled", "artifact", "artifact", "plausible", "plausible", "plausible"],
  );
  assert.deepEqual(
    [1, 99, 10, 4711].map((id) => labels.name(id)),
    ["artifact", "plausible", "car", "class 4711"],
  );
  assert.equal(labels.choiceName(null), "machine's guess");
});

test("classes are found by name, cluster and number; those that begin with it first", () => {
  const found = (typed: string): number[] => searchClasses(CLASSES, typed).map(({ id }) => id);
  assert.deepEqual(found("car"), [10, 252]);
  assert.deepEqual(found(" ARTI"), [1, 40]);
  assert.deepEqual(found("252"), [252]);
  assert.deepEqual(found(""), [1, 10, 40, 252]);
  assert.deepEqual(found("tree"), []);
});

test("keys have one name each, with or without their shift", () => {
  const event = { key: "z", code: "KeyZ", ctrlKey: false, metaKey: false, shiftKey: false, altKey: false };
  assert.equal(keyName({ ...event, key: "Z", ctrlKey: true, shiftKey: true }), "ctrl+shift+z");
  assert.equal(keyName({ ...event, metaKey: true }), "ctrl+z");
  assert.equal(keyName({ ...event, key: "?", shiftKey: true }), "?");
  assert.equal(keyName({ ...event, key: "ArrowLeft" }), "arrowleft");
  assert.equal(keyName({ ...event, key: "я", ctrlKey: true }), "ctrl+z", "where the letter lies on a Russian keyboard");
  assert.equal(keyName({ ...event, key: "y" }), "y", "Latin letters count as they are printed");
  assert.equal(keyName({ ...event, key: "х", code: "BracketLeft" }), "х");
  assert.equal(keyName({ ...event, key: "é", code: "KeyW" }), "é", "a Latin letter is printed on its own key");
  assert.deepEqual(shownKey("ctrl+shift+z"), ["Ctrl", "Shift", "Z"]);
  assert.deepEqual(shownKey("+"), ["+"]);
});

test("numbers are written as people read them", () => {
  assert.deepEqual(
    [decimal(1.005, 1), decimal(Number.NaN, 2), counted(1, "scan"), counted(1234, "scan")],
    ["1.0", "–", "1 scan", "1,234 scans"],
  );
  assert.equal(secondsBetween("1600000000000000000", "1600000000250000000"), 0.25);
  assert.equal(clock("not a time"), "not a time");
});
