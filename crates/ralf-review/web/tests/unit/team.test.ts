import assert from "node:assert/strict";
import { test } from "node:test";
import type { Agreement, Disagreement, Saying, Workday } from "../../src/api/types.js";
import { comparedScans, keyOf, nextDisagreement, peopleOf, perHour, withMarksTogether } from "../../src/data/team.js";

function disagreement(thing: number, by = "bob"): Disagreement {
  const counts = { detections: 9, scans: 2, plausible: 9, answered: 0, expected_errors: 1 };
  const where = { place: [0, 0, 0], radius: 1, radar: "front", scan: 0, point: 0 } as const;
  return { thing, first: 1, second: 99, first_cause: null, second_cause: null, by, points: [], ...counts, ...where };
}

test("disagreements are looked at one after the other, and those that were passed over come again", () => {
  const all = [disagreement(1), disagreement(1, "cem"), disagreement(2)];
  const seen = new Set<string>();
  const visited = [0, 1, 2, 3].map(() => {
    const next = nextDisagreement(all, seen);
    assert.ok(next !== null);
    seen.add(keyOf(next));
    return [next.thing, next.by];
  });
  assert.deepEqual(visited, [
    [1, "bob"],
    [1, "cem"],
    [2, "bob"],
    [1, "bob"],
  ]);
  assert.equal(nextDisagreement([], seen), null);
});

test("scans that were not dealt are told beside those that count", () => {
  const counts = { labelled_by_both: 9, disagree: 0, kappa: 1 } as Agreement["agreement"]["overall"];
  const agreement = { overall: counts, radars: {}, classes: {} };
  const told = (left_out: number): string => comparedScans("ada", { second: "bob", scans: 1, left_out, agreement });
  assert.equal(told(0), "ada and bob, 1 scan");
  assert.equal(told(2), "ada and bob, 1 scan; 2 scans not dealt to bob left out");
});

test("a person's days are summed up, first and second labels apart", () => {
  const day = (author: string, second: boolean, worked_s: number): Workday => ({
    author,
    second,
    day: "2026-01-31",
    edits: 3,
    detections: 40,
    scans: 2,
    worked_s,
  });
  const people = peopleOf([day("ada", false, 1800), day("ada", false, 1800), day("ada", true, 0)]);
  assert.deepEqual(
    people.map(({ name, second, days, detections, hours }) => [name, second, days, detections, hours]),
    [
      ["ada", false, 2, 80, 1],
      ["ada", true, 1, 40, 0],
    ],
  );
  assert.equal(perHour(people[0].detections, people[0].hours), 80);
  assert.ok(Number.isNaN(perHour(40, 0)));
});

test("marks of a thing's scans are told as one, and strokes each by itself", () => {
  const saying = (author: string, tool: string, holds = true): Saying => ({
    author,
    at: "2026-01-31T12:00:00.000Z",
    tool,
    label: null,
    cause: null,
    detections: 2,
    holds,
  });
  const said = [
    saying("ada", "reviewed"),
    saying("ada", "reviewed"),
    saying("ada", "reviewed", false),
    saying("bob", "reviewed"),
    saying("bob", "lasso"),
    saying("bob", "lasso"),
  ];
  assert.deepEqual(
    withMarksTogether(said).map(({ author, tool, detections }) => [author, tool, detections]),
    [
      ["ada", "reviewed", 4],
      ["ada", "reviewed", 2],
      ["bob", "reviewed", 2],
      ["bob", "lasso", 2],
      ["bob", "lasso", 2],
    ],
  );
});
