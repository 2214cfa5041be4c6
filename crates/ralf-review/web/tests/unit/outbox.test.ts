import assert from "node:assert/strict";
import { test } from "node:test";
import { Conflict, Refused, ServerGone } from "../../src/api/errors.js";
import type { StrokeAnswer } from "../../src/api/types.js";
import {
  afterOwn,
  type Errand,
  type Met,
  Outbox,
  type OutboxStatus,
  type Pending,
  pointsIn,
} from "../../src/history/outbox.js";
import { made } from "./scans.js";

const HISTORY = { undo: null, redo: null, undo_depth: 0, redo_depth: 0 };

function stroke(points: readonly number[], revision: number, label: number | null = 99): Pending {
  const base = [{ radar: "front", scan: 3, revision }];
  return {
    sequence: "00",
    stroke: {
      id: `stroke ${points.join()}`,
      tool: "lasso",
      protect: true,
      label,
      base,
      points: [{ radar: "front", scan: 3, points }],
    },
  };
}

/** A server that counts revisions and refuses a stroke on any but the newest. */
class FakeServer {
  revision = 0;
  /** Who changed the scan last. */
  author = "grace";
  trouble: Error | null = null;
  stale = false;
  readonly asked: string[] = [];
  readonly written: number[][] = [];
  readonly kept: Pending[][] = [];
  readonly said: string[] = [];
  last: OutboxStatus = { kind: "idle" };

  readonly outbox = new Outbox({
    send: (pending) => this.take(pending),
    keep: (waiting) => this.kept.push([...waiting]),
    saved: () => undefined,
    status: (status) => {
      this.last = status;
      this.said.push(status.kind);
    },
  });

  /** Takes the last stroke back, in its turn. */
  undo(): Promise<void> {
    const run: Errand["run"] = async () => {
      await Promise.resolve();
      if (this.written.pop() === undefined) this.said.push("nothing to undo");
      const base = [{ radar: "front", scan: 3, revision: this.revision }];
      this.revision += 1;
      const scans = [{ ...base[0], revision: this.revision, causes: [], corrections: [], reviewed: null }];
      return { sequence: "00", base, scans };
    };
    return this.outbox.ask({ sequence: "00", base: [], run, refuse: () => this.said.push("refused") });
  }

  private async take({ stroke: { id, base, points, label } }: Pending): Promise<StrokeAnswer> {
    await Promise.resolve();
    this.asked.push(id);
    if (this.trouble !== null) throw this.trouble;
    const corrections = points[0].points.map((point) => [point, label ?? 0] as const);
    if (base[0].revision !== this.revision) {
      const scans = [{ radar: "front", scan: 3, revision: this.revision, causes: [], corrections: [], reviewed: null }];
      throw new Conflict({
        error: "changed",
        stale: this.stale,
        conflict: { author: this.author, at: "", tool: "box", radar: "front", scan: 3 },
        scans,
      });
    }
    this.revision += 1;
    this.author = "ada";
    this.written.push([...points[0].points]);
    return {
      changed: points[0].points.length,
      scans: [{ radar: "front", scan: 3, revision: this.revision, causes: [], corrections, reviewed: null }],
      history: HISTORY,
    };
  }
}

test("strokes made at once are saved in order, each on the revision the one before it made", async () => {
  const server = new FakeServer();
  await Promise.all([server.outbox.add([stroke([1], 0)]), server.outbox.add([stroke([2], 0), stroke([3], 0)])]);
  await new Promise((resolve) => setTimeout(resolve, 5));
  assert.deepEqual(server.written, [[1], [2], [3]]);
  assert.equal(server.last.kind, "idle");
  assert.deepEqual(server.kept.at(-1), []);
});

test("nothing is called idle before the answer came", async () => {
  const server = new FakeServer();
  const saving = server.outbox.add([stroke([1], 0)]);
  assert.equal(server.last.kind, "saving");
  await saving;
  assert.equal(server.last.kind, "idle");
});

test("while the server is gone strokes are kept, and saved in order on its return", async () => {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await server.outbox.add([stroke([1], 0)]);
  await server.outbox.add([stroke([2], 0)]);
  assert.equal(server.last.kind, "gone");
  assert.deepEqual(
    server.kept.at(-1)?.map(({ stroke: { points } }) => points[0].points),
    [[1], [2]],
  );
  server.trouble = null;
  await server.outbox.retry();
  assert.deepEqual(server.written, [[1], [2]]);
});

test("another's change before the retry is a conflict and never overwritten silently", async () => {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await server.outbox.add([stroke([1], 0)]);
  server.trouble = null;
  server.revision = 5;
  await server.outbox.retry();
  assert.equal(server.last.kind, "conflict");
  assert.deepEqual(server.written, []);
  await server.outbox.applyAnyway(false);
  assert.deepEqual(server.written, [[1]]);
  assert.equal(server.last.kind, "idle");
});

/** Strokes that wait for the server while another person changes their scan. */
async function overtaken(strokes: readonly Pending[]): Promise<FakeServer> {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await server.outbox.add(strokes);
  server.trouble = null;
  server.revision = 5;
  await server.outbox.retry();
  return server;
}

function inGroup(pending: Pending, group: string): Pending {
  return { ...pending, stroke: { ...pending.stroke, group } };
}

test("who applies one stroke anyway is asked about each later one, and told whose edit lies below", async () => {
  const server = await overtaken([stroke([1], 0), stroke([2], 0), stroke([3], 0)]);
  for (const point of [1, 2, 3]) {
    assert.equal(server.last.kind, "conflict");
    const { body, pending } = server.last as Met;
    assert.deepEqual([body.conflict?.author, pending.stroke.points[0].points], ["grace", [point]]);
    if (point < 3) await server.outbox.applyAnyway(false);
  }
  assert.deepEqual(server.written, [[1], [2]]);
  await server.outbox.drop();
  assert.deepEqual([server.written, server.last.kind], [[[1], [2]], "idle"]);
});

test("a stroke that is made while another is applied anyway rests on it", async () => {
  const server = await overtaken([stroke([1], 0)]);
  await Promise.all([server.outbox.applyAnyway(false), server.outbox.add([stroke([2], 5)])]);
  assert.deepEqual([server.written, server.last.kind], [[[1], [2]], "idle"]);
});

test("halves of one step are applied together, and each spares what is corrected if so asked", async () => {
  const server = await overtaken([inGroup(stroke([1], 0), "flip"), inGroup(stroke([2], 0), "flip"), stroke([3], 0)]);
  const applied = server.outbox.applyAnyway(false);
  assert.deepEqual(
    server.kept.at(-1)?.map(({ stroke: { protect } }) => protect),
    [false, false, true],
  );
  await applied;
  const { body, pending } = server.last as Met;
  assert.deepEqual([server.written, pending.stroke.points[0].points], [[[1], [2]], [3]]);
  assert.equal(body.conflict?.author, "grace");
});

test("a stroke in another sequence keeps what it was made on, whatever is applied anyway", async () => {
  const elsewhere = { ...stroke([2], 0), sequence: "01" };
  const server = await overtaken([stroke([1], 0), elsewhere]);
  await server.outbox.applyAnyway(false);
  const { body, pending } = server.last as Met;
  assert.deepEqual([server.written, pending], [[[1]], elsewhere]);
  assert.equal(body.conflict?.author, "ada", "and is not told of an edit in this one");
});

test("strokes in another sequence aren't drawn into this one", () => {
  const [here, elsewhere] = [stroke([1], 0), { ...stroke([2], 0), sequence: "01" }];
  assert.deepEqual(pointsIn("01", [], [here, elsewhere]), elsewhere.stroke.points);
});

test("a stroke isn't drawn into a scan that holds other detections than it was made on", () => {
  const { sequence, stroke: drawn } = stroke([1], 0);
  const base = drawn.base.map((one) => ({ ...one, content: "then" }));
  const count = (content: string): number => {
    const scans = base.map(({ radar, scan }) => made(radar, scan, { x: [1, 2], content }));
    return pointsIn(sequence, scans, [{ sequence, stroke: { ...drawn, base } }]).length;
  };
  assert.deepEqual([count("then"), count("now")], [1, 0]);
});

test("a conflict may be dropped; the strokes behind it go on", async () => {
  const server = new FakeServer();
  server.revision = 2;
  await server.outbox.add([stroke([1], 1), stroke([2], 2)]);
  assert.equal(server.last.kind, "conflict");
  await server.outbox.drop();
  assert.deepEqual(server.written, [[2]]);
});

test("halves of one step are dropped together", async () => {
  const server = new FakeServer();
  server.revision = 2;
  const half = (point: number): Pending => inGroup(stroke([point], 1), "flip");
  await server.outbox.add([half(1), half(2), stroke([3], 2)]);
  await server.outbox.drop();
  assert.deepEqual(server.written, [[3]]);
});

test("where the server is gone the last stroke is dropped, with its group, and not the first", async () => {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await server.outbox.add([stroke([1], 0)]);
  const half = (point: number): Pending => inGroup(stroke([point], 0), "flip");
  await server.outbox.add([half(2), half(3)]);
  await server.outbox.drop();
  assert.deepEqual(
    server.kept.at(-1)?.map(({ stroke: { points } }) => points[0].points),
    [[1]],
  );
  server.trouble = null;
  await server.outbox.retry();
  assert.deepEqual(server.written, [[1]]);
});

test("what is asked for while a stroke is being saved is done after it, and before strokes made later", async () => {
  const server = new FakeServer();
  const all = [server.outbox.add([stroke([1], 0)]), server.undo(), server.outbox.add([stroke([2], 0)]), server.undo()];
  // It rests on what was on screen when it was drawn, and is no conflict with one's own undo.
  all.push(server.outbox.add([stroke([3], 0)]));
  await Promise.all(all);
  assert.deepEqual([server.written, server.last.kind, server.revision], [[[3]], "idle", 5]);
  assert.deepEqual(server.asked, ["stroke 1", "stroke 2", "stroke 3"]);
});

test("an edit rests on the revision that the strokes before it led to", async () => {
  const server = new FakeServer();
  let rested: number | undefined;
  const saving = server.outbox.add([stroke([1], 0)]);
  const run: Errand["run"] = ([{ revision }]) => {
    rested = revision;
    return Promise.resolve(null);
  };
  const base = [{ radar: "front", scan: 3, revision: 0 }];
  await Promise.all([saving, server.outbox.ask({ sequence: "00", base, run, refuse: () => undefined })]);
  assert.equal(rested, 1);
});

test("what is asked for behind a stroke that can't be saved is given up, and said to be", async () => {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await Promise.all([server.outbox.add([stroke([1], 0)]), server.undo()]);
  assert.deepEqual(server.said.slice(-2), ["gone", "refused"]);
  await server.undo();
  assert.equal(server.said.at(-1), "refused");
  server.trouble = null;
  await server.outbox.retry();
  assert.deepEqual([server.written, server.last.kind], [[[1]], "idle"]);
});

test("a refusal says why and keeps the stroke", async () => {
  const server = new FakeServer();
  server.trouble = new Refused(500, "disk full");
  await server.outbox.add([stroke([1], 0)]);
  assert.deepEqual(server.last, { kind: "refused", message: "disk full" });
  assert.equal(server.kept.at(-1)?.length, 1);
});

test("a stroke whose answer was lost is asked for again under its name", async () => {
  const server = new FakeServer();
  server.trouble = new ServerGone();
  await server.outbox.add([stroke([1], 0)]);
  server.trouble = null;
  await server.outbox.retry();
  assert.deepEqual(server.asked, ["stroke 1", "stroke 1"]);
});

test("a stroke on detections that aren't there any more can only be dropped", async () => {
  const server = new FakeServer();
  [server.revision, server.stale] = [2, true];
  await server.outbox.add([stroke([1], 1)]);
  await server.outbox.applyAnyway(false);
  assert.deepEqual([server.last.kind, server.written], ["conflict", []]);
  await server.outbox.drop();
  assert.equal(server.last.kind, "idle");
});

test("strokes that wait are the same objects until they rest on another revision, so that each is kept once", () => {
  const [first, second, elsewhere] = [stroke([1], 0), stroke([2], 0), { ...stroke([3], 0), sequence: "01" }];
  const answered = [{ radar: "front", scan: 3, revision: 1, causes: [], corrections: [], reviewed: null }];
  const own = { sequence: "00", base: first.stroke.base, scans: answered };
  const after = [second, elsewhere, stroke([4], 7)].map((waiting) => afterOwn(waiting, own));
  assert.deepEqual(
    after.map(({ stroke: { base } }) => base[0].revision),
    [1, 0, 7],
  );
  assert.equal(after[1], elsewhere);
});
