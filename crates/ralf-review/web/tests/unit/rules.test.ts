import assert from "node:assert/strict";
import { test } from "node:test";
import { buildCloud, withScans } from "../../src/data/cloud.js";
import { everything } from "../../src/data/filter.js";
import { countAlready, rulesFrom, rulesText, verdictOf, verdictText } from "../../src/data/rules.js";
import { withCorrections } from "../../src/data/scan.js";
import { made } from "./scans.js";

const CAUSES = ["", "road", "mirror"];

test("rules come back with what they set, and those of before rules could set something choose as they did", () => {
  const filter = { ...everything, uncertain: true };
  const rules = [
    { name: "ghosts", filter, sets: { label: 1, cause: "mirror" } },
    { name: "trees", filter, sets: { label: 70, cause: null } },
    { name: "weak", filter, sets: null },
  ];
  assert.deepEqual(rulesFrom(rulesText(rules)), rules);
  assert.deepEqual(rulesFrom('{"old": {"uncertain": true}}'), [{ name: "old", filter, sets: null }]);
  for (const odd of ['{"sets": 7}', '{"sets": {"cause": "road"}}', "7", "null"])
    assert.equal(rulesFrom(`{"odd": ${odd}}`)[0].sets, null, odd);
});

test("a verdict is a choice in a list, and back", () => {
  for (const sets of [null, { label: 99, cause: null }, { label: 1, cause: "inside building" }])
    assert.deepEqual(verdictOf(verdictText(sets)), sets);
});

test("a cause that was said is of its detection until it is taken back, and isn't said again", () => {
  const scan = made("front", 0, { x: [1, 2, 3] });
  const told = { radar: "front", scan: 0, reviewed: null };
  const corrections = [
    [0, 1],
    [2, 1],
  ] as const;
  const said = withCorrections(scan, { ...told, revision: 1, corrections, causes: [[2, 2]] });
  assert.deepEqual([...said!.saidCause], [0, 0, 2]);
  const cloud = withScans(buildCloud([scan]), [said!]);
  assert.deepEqual([...cloud.saidCause], [0, 0, 2]);
  const all = new Uint8Array([1, 1, 1]);
  assert.equal(countAlready(cloud, all, { label: 1, cause: "mirror" }, CAUSES), 1);
  assert.equal(countAlready(cloud, all, { label: 1, cause: null }, CAUSES), 2);
  assert.equal(countAlready(cloud, new Uint8Array([1, 1, 0]), { label: 99, cause: null }, CAUSES), 1);
  const back = withCorrections(said!, { ...told, revision: 2, corrections: [], causes: [] });
  assert.deepEqual([...back!.saidCause], [0, 0, 0]);
});
