import assert from "node:assert/strict";
import { test } from "node:test";
import { allSources, BY_PERSON, sourceName, UNTOLD } from "../../src/data/classes.js";
import { buildCloud, type Cloud, withScans } from "../../src/data/cloud.js";
import { everything, type Filter, hides, visible } from "../../src/data/filter.js";
import { filterFrom, plainFilter } from "../../src/data/kept-filter.js";
import { LabelBook } from "../../src/data/labels.js";
import { withCorrections } from "../../src/data/scan.js";
import { paint } from "../../src/viewer/colours.js";
import { ARTIFACT_RGB, PLAUSIBLE_RGB } from "../../src/viewer/palette.js";
import { recordingOf } from "./recordings.js";
import { made } from "./scans.js";

const recording = recordingOf([]);
const [LIDAR, CAMERA] = [1, 2];
const labels = new LabelBook([
  { id: 1, name: "outlier", cluster: "artifact", plausible: false },
  { id: 10, name: "car", cluster: "vehicle", plausible: true },
  { id: 40, name: "road", cluster: "artifact", plausible: false },
  { id: 70, name: "vegetation", cluster: "vegetation", plausible: true },
  { id: 252, name: "moving-car", cluster: "vehicle", plausible: true },
]);

/** A car by the LiDAR, a bush by a camera, a plausible one without class, an artifact. */
const scan = made("front", 0, { x: [1, 2, 3, 4], machine: [10, 70, 99, 1], classFrom: [LIDAR, CAMERA, 0, 0] });
const told = { radar: "front", scan: 0, revision: 1, causes: [], reviewed: null };

function after(corrections: readonly (readonly [number, number])[]): Cloud {
  return withScans(buildCloud([scan]), [withCorrections(scan, { ...told, corrections })!]);
}

const legend = (cloud: Cloud, mode: string): readonly string[] => {
  const { legend } = paint(cloud, mode, labels, recording);
  return legend.kind === "categories" ? legend.entries.map(([name]) => name) : [];
};

test("a class is told by who gave it, and what a person says is theirs until they take it back", () => {
  assert.deepEqual([...buildCloud([scan]).classFrom], [LIDAR, CAMERA, UNTOLD, UNTOLD]);
  // The same class again, said by a person, is a person's; plausible without more is no class.
  const said = after([
    [0, 10],
    [1, 99],
    [2, 10],
    [3, 40],
  ]);
  assert.deepEqual([...said.classFrom], [BY_PERSON, UNTOLD, BY_PERSON, BY_PERSON]);
  assert.deepEqual([...after([]).classFrom], [LIDAR, CAMERA, UNTOLD, UNTOLD]);
});

test("a class that somebody accepted before the machine said otherwise is a person's", () => {
  const accepted = { ...scan, label: new Uint16Array([70, 70, 99, 1]) };
  assert.deepEqual([...buildCloud([accepted]).classFrom], [BY_PERSON, CAMERA, UNTOLD, UNTOLD]);
});

test("every source has a name", () => {
  assert.deepEqual(
    allSources(recording).map((source) => sourceName(source, recording)),
    ["a person", "lidar", "camera", "no class"],
  );
});

test("the filter asks for classes and for who tells them", () => {
  const cloud = after([[2, 10]]);
  const shown = (filter: Partial<Filter>): number[] => [
    ...visible(cloud, { ...everything, ...filter }, labels, { threshold: 0.5, decided: 1 }),
  ];
  assert.deepEqual(shown({ classes: new Set([10]) }), [1, 0, 1, 0]);
  assert.deepEqual(shown({ classes: new Set([10, 70]) }), [1, 1, 1, 0]);
  assert.deepEqual(shown({ classFrom: new Set([CAMERA]) }), [0, 1, 0, 0]);
  assert.deepEqual(shown({ classes: new Set([10]), classFrom: new Set([BY_PERSON]) }), [0, 0, 1, 0]);
  assert.deepEqual(shown({ classFrom: new Set([UNTOLD]) }), [0, 0, 0, 1]);
  const asked = { ...everything, classes: new Set([10]), classFrom: new Set([CAMERA]) };
  assert.ok(hides(asked) && hides({ ...everything, classFrom: new Set([CAMERA]) }));
  assert.deepEqual(filterFrom(JSON.parse(JSON.stringify(plainFilter(asked)))), asked);
  assert.deepEqual(filterFrom({ classes: ["car", null], classFrom: 7 }), everything);
});

test("colours by class tell what is there alone, moving ones like still ones", () => {
  const cloud = buildCloud([scan]);
  assert.deepEqual(legend(cloud, "class"), ["artifact", "car", "vegetation", "plausible, no class"]);
  const { colours } = paint(cloud, "class", labels, recording);
  assert.deepEqual([...colours.subarray(6)], [...PLAUSIBLE_RGB, ...ARTIFACT_RGB]);
  const moving = paint(after([[0, 252]]), "class", labels, recording).colours;
  assert.deepEqual(moving.subarray(0, 3), colours.subarray(0, 3));
  assert.notDeepEqual(colours.subarray(0, 3), colours.subarray(3, 6));
  // What lies on the road is an artifact, and looks like one.
  const road = paint(after([[0, 40]]), "class", labels, recording);
  assert.deepEqual([...road.colours.subarray(0, 3)], [...ARTIFACT_RGB]);
});

test("colours by source tell who gave the classes that are there", () => {
  assert.deepEqual(legend(buildCloud([scan]), "class from"), ["lidar", "camera", "no class"]);
  assert.deepEqual(legend(after([[0, 70]]), "class from"), ["a person", "camera", "no class"]);
});
