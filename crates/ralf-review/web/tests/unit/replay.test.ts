import assert from "node:assert/strict";
import { test } from "node:test";
import type { Adopting } from "../../src/actions/adopting.js";
import { Correcting } from "../../src/actions/correcting.js";
import type { Navigation } from "../../src/actions/navigation.js";
import { Replaying } from "../../src/actions/replaying.js";
import type { World } from "../../src/actions/world.js";
import type { ScanId, StrokeRequest } from "../../src/api/types.js";
import type { Area } from "../../src/data/area.js";
import { everything, type Filter } from "../../src/data/filter.js";
import { sequencesOf } from "../../src/data/replay.js";
import { type Rule, rulesText } from "../../src/data/rules.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

/** What is farther than 5 m is an artifact. */
const FAR: Filter = { ...everything, range: [5, Infinity] };

function keeping(...rules: readonly Rule[]): void {
  const kept = { getItem: () => rulesText(rules), setItem: () => undefined };
  Object.defineProperty(globalThis, "localStorage", { value: kept, configurable: true });
}

/** Two sequences of ada's, with eight scans and with one, another one that can't be read, and one of bob's. */
class Team {
  readonly store = new Store<State>(
    initialState(
      recordingOf([sequence("00", "ada"), sequence("01", "bob"), sequence("02", "ada"), sequence("03", "ada")]),
      "ada",
    ),
  );
  readonly sent: { readonly sequence: string; readonly stroke: StrokeRequest }[] = [];
  readonly asked: string[] = [];
  readonly replaying: Replaying;

  constructor() {
    const scans = (count: number): ScanId[] => Array.from({ length: count }, (_, scan) => ({ radar: "front", scan }));
    const api = {
      queue: (name: string) =>
        name === "03" ? Promise.reject(new Error("gone")) : Promise.resolve({ scans: scans(name === "00" ? 8 : 1) }),
      scan: (name: string, { scan }: ScanId) => {
        this.asked.push(`${name}/${scan}`);
        // Near, far, far and so already, far and corrected.
        const machine = [99, 99, 1, 99];
        return Promise.resolve(made("front", scan, { x: [1, 9, 9, 9], machine, corrected: [0, 0, 0, 1] }).table);
      },
      stroke: (name: string, stroke: StrokeRequest) => {
        this.sent.push({ sequence: name, stroke });
        return Promise.resolve({ changed: 1, scans: [], history: this.store.state.history });
      },
    };
    const world = { store: this.store, api } as unknown as World;
    const keeper = { found: [], keep: () => Promise.resolve() };
    const adopting = { adopt: () => Promise.resolve() } as unknown as Adopting;
    this.replaying = new Replaying(world, new Correcting(world, {} as Navigation, adopting, keeper));
  }
}

test("a rule is asked of all scans of one's own sequences, and set in each as one stroke", async () => {
  keeping({ name: "far", filter: FAR, sets: { label: 1, cause: null } });
  const team = new Team();
  await team.replaying.start("far");
  const parts = team.store.state.replay?.parts ?? [];
  const told = parts.map((part) => [part.sequence, part.detections, part.already, part.spared, part.problem]);
  assert.deepEqual(told, [
    ["00", 8, 8, 8, null],
    ["02", 1, 1, 1, null],
    ["03", 0, 0, 0, "gone"],
  ]);
  assert.deepEqual(
    [team.sent.length, team.store.state.dialog],
    [0, "replay"],
    "nothing is done before it is confirmed",
  );
  await team.replaying.apply();
  const strokes = team.sent.map(({ sequence: name, stroke: { tool, label, protect, points, base } }) => [
    name,
    [tool, label, protect],
    points.map(({ points: some }) => some),
    base.length,
  ]);
  assert.deepEqual(strokes, [
    ["00", ["rule", 1, true], Array.from({ length: 8 }, () => [1]), 8],
    ["02", ["rule", 1, true], [[1]], 1],
  ]);
  assert.match(team.store.state.notice?.text ?? "", /9 labels changed in 2 sequences/);
  assert.equal(team.store.state.replay, null);
});

test("who closes the list has nothing read on, and nothing changed", async () => {
  keeping({ name: "far", filter: FAR, sets: { label: 1, cause: null } });
  const team = new Team();
  const reading = team.replaying.start("far");
  while (team.store.state.dialog !== "replay") await Promise.resolve();
  team.store.set({ dialog: "none" });
  await reading;
  await team.replaying.apply();
  assert.deepEqual([team.store.state.replay, team.sent, team.asked.length < 8], [null, [], true]);
});

test("a rule that asks for places, or only selects, is no rule for other sequences", async () => {
  const area: Area = { kind: "inside", dataset: "city", sequence: "00", corners: [] };
  const corners = [[0, 0] as const, [1, 0] as const, [1, 1] as const];
  keeping(
    { name: "yard", filter: { ...FAR, areas: [{ ...area, corners }] }, sets: { label: 1, cause: null } },
    { name: "look", filter: FAR, sets: null },
  );
  const team = new Team();
  for (const name of ["yard", "look", "unknown"]) await team.replaying.start(name);
  assert.deepEqual([team.store.state.dialog, team.asked], ["none", []]);
});

test("where nobody has dealt sequences, all that are labelled are one's own", () => {
  const own = sequencesOf({ sequences: [sequence("00"), sequence("01", null, false), sequence("02")] }, "ada");
  assert.deepEqual(
    own.map(({ name }) => name),
    ["00", "02"],
  );
});
