import assert from "node:assert/strict";
import { test } from "node:test";
import { Elsewhere, isAway, type Link, linkAfter, Refused, ServerGone, TokenMissing } from "../../src/api/errors.js";
import type { Pending } from "../../src/history/outbox.js";
import { toDrop, trouble } from "../../src/panels/banner.js";
import { savedState } from "../../src/panels/status-bar.js";
import { initialState, type State } from "../../src/state.js";
import { recordingOf, sequence } from "./recordings.js";

const STROKE: Pending = {
  sequence: "00",
  stroke: { id: "one", tool: "lasso", protect: true, label: 99, base: [], points: [] },
};

function page(link: Link, patch: Partial<State> = {}): State {
  return { ...initialState(recordingOf([sequence("00")]), "ada"), link, ...patch };
}

test("a server that can't read the corrections is told as long as it can't, and nothing is called saved", () => {
  const broken = linkAfter(new Refused(500, "found that it was deleted; nothing is saved any more"));
  assert.equal(trouble(page(broken)), "found that it was deleted; nothing is saved any more");
  assert.deepEqual(savedState(page(broken)), ["nothing is saved", "alarm"]);
  assert.deepEqual([trouble(page({ kind: "fine" })), savedState(page({ kind: "fine" }))], [null, ["saved", "fine"]]);
  assert.deepEqual(savedState(page(linkAfter(new ServerGone()))), ["offline", "alarm"]);
});

test("of other corrections under the same address the page says whose they are, and that strokes wait for their own", () => {
  const link = linkAfter(new Elsewhere("corrections: expected those of the page, found those of `oB`"));
  const state = page(link, { waiting: [STROKE], outbox: { kind: "gone", link } });
  const said = trouble(state) ?? "";
  for (const part of ["Another recording or output is served here now", "`oB`", "1 stroke not saved; kept"])
    assert.ok(said.includes(part), said);
  assert.deepEqual(savedState(state), ["1 stroke not saved", "alarm"]);
  assert.deepEqual(savedState(page(link)), ["nothing is saved", "alarm"]);
});

test("the stroke that would be dropped is named before it is", () => {
  const points = [{ radar: "front", scan: 3, points: [1, 2] }];
  const other: Pending = { ...STROKE, stroke: { ...STROKE.stroke, label: 1, points } };
  const waiting = [other, STROKE];
  const [gone, refused] = [
    page({ kind: "gone" }, { waiting, outbox: { kind: "gone", link: { kind: "gone" } } }),
    page({ kind: "fine" }, { waiting, outbox: { kind: "refused", message: "no" } }),
  ];
  assert.equal(toDrop(gone), "Drop the last stroke (plausible, 0 detections)");
  assert.equal(toDrop(refused), "Drop the refused stroke (artifact, 2 detections)");
  assert.equal(toDrop(page({ kind: "fine" }, { waiting, outbox: { kind: "saving" } })), null);
});

test("a server that knows another token refuses no stroke for good: it may be another one", () => {
  assert.deepEqual([new TokenMissing(), new Refused(400, "no")].map(isAway), [true, false]);
});
