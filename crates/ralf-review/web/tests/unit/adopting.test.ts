import assert from "node:assert/strict";
import { test } from "node:test";
import { Adopting } from "../../src/actions/adopting.js";
import { Moment } from "../../src/actions/moment.js";
import type { Queueing } from "../../src/actions/queueing.js";
import type { World } from "../../src/actions/world.js";
import type { Api } from "../../src/api/client.js";
import { Conflict } from "../../src/api/errors.js";
import type { ScanCorrections, ScanId } from "../../src/api/types.js";
import { buildCloud } from "../../src/data/cloud.js";
import { Loader } from "../../src/data/loader.js";
import type { Scan } from "../../src/data/scan.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";
import { made } from "./scans.js";

/** The same radar and scan in every sequence. */
const HERE = { radar: "front", scan: 0 };
const [NEXT, LAST] = [1, 2].map((scan) => ({ radar: "front", scan }));
const [ARTIFACT, PLAUSIBLE] = [1, 99];

/** What a stroke on the first detection of a scan led to. */
function corrected(id: ScanId): ScanCorrections {
  return { ...id, revision: 1, corrections: [[0, ARTIFACT]], causes: [], reviewed: null };
}

/** A page on a scan, and a server whose answers come when a test says so: "scan 1", "moment". */
class Desk {
  readonly store = new Store<State>(initialState(recordingOf([sequence("00"), sequence("01")]), "ada"));
  readonly adopting: Adopting;
  readonly moment: Moment;
  /** What the server says of both detections of every scan. */
  readonly now = [PLAUSIBLE, PLAUSIBLE];
  private readonly answers = new Map<string, () => void>();

  constructor() {
    const api = {
      scan: (_: string, { radar, scan }: ScanId) => this.answer(`scan ${scan}`, this.made(radar, scan).table),
      moment: () => this.answer("moment", [HERE, NEXT, LAST]),
    } as unknown as Api;
    const world = { store: this.store, api, loader: new Loader(api) } as unknown as World;
    this.adopting = new Adopting(world, { soon: () => undefined } as unknown as Queueing);
    this.moment = new Moment(world);
    this.open("00");
  }

  get labels(): readonly number[] {
    return [...this.store.state.cloud.label];
  }

  open(name: string): void {
    this.store.set({ sequence: name, current: HERE, cloud: buildCloud([this.made("front", 0)]) });
  }

  /** Lets answers come that are waited for, and what follows from each happen. */
  async come(...names: readonly string[]): Promise<void> {
    for (const name of names) {
      this.answers.get(name)?.();
      await new Promise((resolve) => setTimeout(resolve));
    }
  }

  private made(radar: string, scan: number): Scan {
    return made(radar, scan, { x: [1, 2], machine: this.now });
  }

  private answer<Answer>(name: string, answer: Answer): Promise<Answer> {
    return new Promise((resolve) => this.answers.set(name, () => resolve(answer)));
  }
}

test("a stroke that is saved while the scans around it are read stays in the picture", async () => {
  const desk = new Desk();
  const showing = desk.moment.show(HERE);
  await desk.come("scan 0");
  await desk.adopting.adopt("00", [corrected(HERE)]);
  await desk.come("moment", "scan 1", "scan 2");
  await showing;
  assert.deepEqual(desk.labels, [ARTIFACT, ...Array<number>(5).fill(PLAUSIBLE)]);
});

test("so does one on a scan that wasn't on screen: it is read anew", async () => {
  const desk = new Desk();
  const showing = desk.moment.show(HERE);
  await desk.come("scan 0", "moment", "scan 1");
  await desk.adopting.adopt("00", [corrected(NEXT)]);
  desk.now[0] = ARTIFACT;
  await desk.come("scan 2", "scan 1");
  await showing;
  assert.deepEqual(desk.labels.slice(2, 4), [ARTIFACT, PLAUSIBLE]);
});

test("so does one on a scan that is being read anew for another's change", async () => {
  const desk = new Desk();
  const reading = desk.adopting.reread("00", desk.store.state.cloud.scans);
  await desk.adopting.adopt("00", [corrected(HERE)]);
  await desk.come("scan 0");
  await reading;
  assert.deepEqual(desk.labels, [ARTIFACT, PLAUSIBLE]);
});

test("what was read anew of a sequence that was left meanwhile isn't put into another", async () => {
  const desk = new Desk();
  desk.now[0] = ARTIFACT;
  const reading = desk.adopting.reread("00", desk.store.state.cloud.scans);
  desk.now[0] = PLAUSIBLE;
  desk.open("01");
  await desk.come("scan 0");
  await reading;
  assert.deepEqual(desk.labels, [PLAUSIBLE, PLAUSIBLE]);
});

test("what is refused in a sequence that was left changes nothing in another, and is told with its name", async () => {
  const desk = new Desk();
  desk.open("01");
  const conflict = { author: "bob", at: "", tool: "lasso", ...HERE };
  const error = new Conflict({ error: "changed", stale: false, conflict, scans: [corrected(HERE)] });
  await desk.adopting.refused("00", "marked", error);
  assert.deepEqual(desk.labels, [PLAUSIBLE, PLAUSIBLE]);
  assert.equal(desk.store.state.notice?.text, "Not marked in sequence 00 (bob, lasso): changed");
});
