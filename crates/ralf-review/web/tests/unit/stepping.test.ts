import assert from "node:assert/strict";
import { mock, test } from "node:test";
import { Adopting } from "../../src/actions/adopting.js";
import type { Correcting } from "../../src/actions/correcting.js";
import { Hearing } from "../../src/actions/hearing.js";
import type { Moment } from "../../src/actions/moment.js";
import type { Navigation } from "../../src/actions/navigation.js";
import { Queueing } from "../../src/actions/queueing.js";
import { Reviewing } from "../../src/actions/reviewing.js";
import { Relabelling } from "../../src/actions/relabelling.js";
import { Stepping } from "../../src/actions/stepping.js";
import type { World } from "../../src/actions/world.js";
import type { Changes, History, QueueScan, ScanId } from "../../src/api/types.js";
import type { Errand, Moved } from "../../src/history/outbox.js";
import { initialState, type State } from "../../src/state.js";
import { Store } from "../../src/store.js";
import { recordingOf, sequence } from "./recordings.js";

const STROKE: History["undo"] = { tool: "lasso", label: 1, at: "", changed: 3 };
const NOTHING: History = { undo: null, redo: null, undo_depth: 0, redo_depth: 0 };
const ONE: History = { ...NOTHING, undo: STROKE, undo_depth: 1 };
const HERE: ScanId = { radar: "front", scan: 1 };

function needs(scan: number, errors: number): QueueScan {
  const said = { corrected: 0, reviewed: null, orphaned: 0 };
  const doubts = { detections: 100, uncertain: 0, disagreeing: 0, cameras_failed: 0 };
  return { radar: "front", scan, t_ns: String(scan), expected_errors: errors, ...doubts, ...said };
}

/** A page on a server that another window of the same browser writes to, too. */
class Window {
  readonly store = new Store<State>(initialState(recordingOf([sequence("00")]), "ada"));
  /** What the server has. */
  history: History = NOTHING;
  scans: readonly QueueScan[] = [needs(1, 80), needs(2, 60)];
  readonly world: World;
  readonly moved: (Moved | null)[] = [];
  readonly queueing: Queueing;
  readonly stepping: Stepping;
  readonly adopting: Adopting;
  readonly correcting: Correcting;
  readonly navigation = { goTo: () => Promise.resolve() } as unknown as Navigation;

  constructor() {
    const api = {
      queue: () => Promise.resolve({ scans: this.scans, progress: this.store.state.progress }),
      history: () => Promise.resolve(this.history),
      undo: () => {
        const changed = this.history.undo?.changed ?? 0;
        if (changed > 0) this.history = { ...NOTHING, redo: STROKE, redo_depth: 1 };
        const scans = changed > 0 ? [{ ...HERE, revision: 2, corrections: [], causes: [], reviewed: null }] : [];
        return Promise.resolve({ changed, scans, history: this.history });
      },
    };
    const loader = { forget: () => undefined };
    this.world = { store: this.store, api, loader } as unknown as World;
    this.store.set({ sequence: "00", scans: this.scans, current: HERE });
    this.queueing = new Queueing(this.world);
    this.adopting = new Adopting(this.world, this.queueing, {} as unknown as Moment);
    const inTurn = async (_: string, { run }: Omit<Errand, "refuse">): Promise<void> =>
      void this.moved.push(await run([]));
    this.correcting = { inTurn } as unknown as Correcting;
    this.stepping = new Stepping(this.world, this.navigation, this.adopting, this.correcting);
  }
}

test("what another window of this browser did can be undone here, though nothing was known of it", async () => {
  const window = new Window();
  window.history = ONE;
  await window.stepping.undo();
  assert.deepEqual([window.store.state.history.redo_depth, window.moved[0]?.scans.length], [1, 1]);
  assert.equal(window.store.state.notice, null);
});

test("what went wrong before is told until a step is made, or somebody goes elsewhere", async () => {
  const window = new Window();
  const { store } = window.world;
  const wrong = { text: "Not marked", kind: "problem" } as const;
  store.set({ notice: wrong });
  window.history = ONE;
  await window.stepping.undo();
  assert.equal(store.state.notice, null);
  new Reviewing(window.world, window.navigation, window.adopting, window.correcting, window.queueing);
  store.set({ notice: wrong });
  store.set({ current: { radar: "front", scan: 2 } });
  assert.equal(store.state.notice, null);
});

test("that nothing is left to undo is said", async () => {
  const window = new Window();
  await window.stepping.undo();
  assert.match(window.store.state.notice?.text ?? "", /Nothing is left to undo/);
});

test("what others change is heard with what can be undone by now, and the order of work", async () => {
  const window = new Window();
  const change = { ...HERE, revision: 1, author: "ada" };
  const changes: Changes[] = [
    { counter: 1, scans: [] },
    { counter: 2, scans: [change] },
  ] as unknown as Changes[];
  const never = new Promise<Changes>(() => undefined);
  const api = { ...window.world.api, changes: () => changes.shift() ?? never };
  const world = { ...window.world, api } as unknown as World;
  const page = { hidden: false, addEventListener: () => undefined, removeEventListener: () => undefined };
  Object.defineProperty(globalThis, "document", { value: page, configurable: true });
  window.history = ONE;
  window.scans = [needs(2, 60), needs(1, 2)];
  new Hearing(world, window.adopting, window.correcting, window.queueing, new Relabelling(world));
  for (let tick = 0; tick < 20 && window.store.state.history !== ONE; tick += 1)
    await new Promise((resolve) => setTimeout(resolve, 10));
  assert.equal(window.store.state.history, ONE);
  // The one that is looked at stays where it is.
  assert.deepEqual(window.store.state.scans, [needs(1, 2), needs(2, 60)]);
});

test("after an own undo the order of work is read anew", async () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  const window = new Window();
  window.history = ONE;
  window.scans = [needs(2, 90), needs(1, 80)];
  await window.stepping.undo();
  mock.timers.tick(1000);
  mock.timers.reset();
  await new Promise((resolve) => setTimeout(resolve, 10));
  assert.deepEqual(window.store.state.scans, window.scans);
});
