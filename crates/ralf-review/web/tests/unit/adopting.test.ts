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
  now: readonly number[] = [PLAUSIBLE, PLAUSIBLE];
  /** What every scan holds, and the run that labelled it. */
  content = "then";
  run = "first";
  private readonly answers = new Map<string, () => void>();

  constructor() {
    const api = {
      scan: (_: string, { radar, scan }: ScanId) => this.answer(`scan ${scan}`, this.made(radar, scan).table),
      moment: () => this.answer("moment", { run: this.run, scans: [HERE, NEXT, LAST] }),
    } as unknown as Api;
    const world = { store: this.store, api, loader: new Loader(api, 1) } as unknown as World;
    this.moment = new Moment(world);
    this.adopting = new Adopting(world, { soon: () => undefined } as unknown as Queueing, this.moment);
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
    const x = this.now.map((_, i) => i + 1);
    return made(radar, scan, { x, machine: this.now, content: this.content, run: this.run });
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
  desk.now = [ARTIFACT, PLAUSIBLE];
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
  desk.now = [ARTIFACT, PLAUSIBLE];
  const reading = desk.adopting.reread("00", desk.store.state.cloud.scans);
  desk.now = [PLAUSIBLE, PLAUSIBLE];
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

test("a scan that holds other detections by now is shown anew, and nothing stays chosen among the old ones", async () => {
  const desk = new Desk();
  desk.store.set({ selection: new Uint8Array([0, 1]), accepting: { all: 1, hidden: 0, goOn: true } });
  [desk.content, desk.now] = ["now", [PLAUSIBLE, PLAUSIBLE, ARTIFACT]];
  const reading = desk.adopting.reread("00", desk.store.state.cloud.scans);
  await desk.come("scan 0");
  const before = desk.store.state;
  assert.deepEqual([before.accepting, [...before.selection]], [null, [0, 0]]);
  assert.equal(before.cloud.scans[0].table.header.content, "then", "a stroke until then is on what is on screen");
  assert.match(before.notice?.text ?? "", /other detections/);
  await desk.come("scan 0", "moment", "scan 1", "scan 2");
  assert.equal(await reading, false);
  const { cloud, selection } = desk.store.state;
  assert.deepEqual([cloud.count, selection.length, cloud.positions[6]], [9, 9, 3]);
  assert.equal(cloud.scans[0].table.header.content, "now");
});

test("scans of an earlier run are not shown beside those of a later one", async () => {
  const desk = new Desk();
  const first = desk.moment.show(HERE);
  await desk.come("scan 0", "moment", "scan 1", "scan 2");
  await first;
  [desk.run, desk.now] = ["second", [ARTIFACT, ARTIFACT]];
  const again = desk.moment.show(HERE);
  await desk.come("scan 0", "moment", "scan 1", "scan 2", "scan 0");
  await again;
  assert.deepEqual(desk.labels, Array<number>(6).fill(ARTIFACT));
});
