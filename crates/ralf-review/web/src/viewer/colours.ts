/** What a detection's colour says, and the legend to it. */

import type { Recording } from "../api/types.js";
import { allSources, present, sourceName, UNTOLD } from "../data/classes.js";
import { columnsOf, gather, type Cloud } from "../data/cloud.js";
import { isClass, type LabelBook, PLAUSIBLE, type Truth } from "../data/labels.js";
import {
  ABSENT_RGB,
  ARTIFACT_RGB,
  CATEGORIES,
  classColour,
  diverging,
  PLAUSIBLE_RGB,
  type Rgb,
  UNLABELLED_RGB,
  viridis,
} from "./palette.js";

/** `label`, `class` and so on; or a column of the result, by its name behind this. */
export type ColourMode = string;
const COLUMN = "column ";

export interface ColourOption {
  readonly value: ColourMode;
  readonly text: string;
  readonly meaning: string;
}

/** What detections can be coloured by: everything that the server tells a number of. */
export function colourModes(cloud: Cloud, { causes }: Pick<Recording, "causes">): readonly ColourOption[] {
  const option = (value: ColourMode, text: string, meaning = ""): ColourOption => ({ value, text, meaning });
  const columns = columnsOf(cloud)
    .filter(({ group }) => group !== "place")
    .map(({ name, meaning }) => option(`${COLUMN}${name}`, name, meaning));
  const cause = causes === null ? [] : [option("cause", "True cause", "as the recording tells it")];
  return [
    option("label", "Label"),
    option("class", "Class"),
    option("class from", "Class from", "what tells the class"),
    ...columns,
    ...cause,
    option("said cause", "Cause said", "why people said that it is an artifact"),
    option("radar", "Radar"),
    option("height", "Height"),
    option("age", "Time"),
  ];
}

export type Legend =
  | { readonly kind: "categories"; readonly entries: readonly (readonly [name: string, colour: Rgb])[] }
  | {
      readonly kind: "scale";
      readonly least: number;
      readonly most: number;
      readonly unit: string;
      readonly map: (share: number) => Rgb;
    };

export interface Painting {
  /** Red, green, blue of each detection. */
  readonly colours: Uint8Array;
  readonly legend: Legend;
}

const TRUTH_COLOURS: Readonly<Record<Truth, Rgb>> = {
  plausible: PLAUSIBLE_RGB,
  artifact: ARTIFACT_RGB,
  unlabelled: UNLABELLED_RGB,
};

/** Velocities beyond this have the map's ends, m/s. */
const VELOCITY_END = 10;

export function truthColour(truth: Truth): Rgb {
  return TRUTH_COLOURS[truth];
}

/** A plausible class has a colour of its own; any other label that of its truth. */
export function labelColour(id: number, labels: LabelBook): Rgb {
  const truth = labels.truth(id);
  return isClass(id) && truth === "plausible" ? classColour(labels.name(id)) : TRUTH_COLOURS[truth];
}

export function paint(cloud: Cloud, mode: ColourMode, labels: LabelBook, recording: Recording): Painting {
  switch (mode) {
    case "label":
      return paintLabels(cloud, labels);
    case "class":
      return paintClasses(cloud, labels);
    case "class from":
      return paintSources(cloud, recording);
    case "cause":
      return paintCauses(gather(cloud, "cause"), recording.causes ?? []);
    case "said cause":
      return paintCauses(cloud.saidCause, recording.sayable_causes);
    case "radar":
      return paintRadars(cloud);
    case "height":
      return paintScale(
        cloud.positions.filter((_, i) => i % 3 === 2),
        -1,
        5,
        "m",
        viridis,
      );
    case "age":
      return paintAge(cloud);
    default:
      return mode.startsWith(COLUMN) ? paintColumn(cloud, mode.slice(COLUMN.length)) : paintLabels(cloud, labels);
  }
}

function paintEach(count: number, colour: (index: number) => Rgb): Uint8Array {
  const colours = new Uint8Array(3 * count);
  for (let i = 0; i < count; i++) colours.set(colour(i), 3 * i);
  return colours;
}

function paintLabels(cloud: Cloud, labels: LabelBook): Painting {
  const colours = paintEach(cloud.count, (i) => TRUTH_COLOURS[labels.truth(cloud.label[i])]);
  const entries = (Object.keys(TRUTH_COLOURS) as Truth[]).map((truth) => [truth, TRUTH_COLOURS[truth]] as const);
  return { colours, legend: { kind: "categories", entries } };
}

/** The legend has what is there alone: SemanticKITTI has more classes than anybody tells apart. */
function paintClasses(cloud: Cloud, labels: LabelBook): Painting {
  const colour = (id: number): Rgb => labelColour(id, labels);
  const name = (id: number): string => (id === PLAUSIBLE ? "plausible, no class" : labels.name(id));
  const entries = present(cloud.label).map((id) => [name(id), colour(id)] as const);
  return { colours: paintEach(cloud.count, (i) => colour(cloud.label[i])), legend: { kind: "categories", entries } };
}

function paintSources({ classFrom, count }: Cloud, recording: Recording): Painting {
  const known = allSources(recording);
  const colour = (source: number): Rgb =>
    source === UNTOLD ? ABSENT_RGB : CATEGORIES[known.indexOf(source) % CATEGORIES.length];
  const there = new Set(classFrom);
  const entries = known
    .filter((source) => there.has(source))
    .map((source) => [sourceName(source, recording), colour(source)] as const);
  return { colours: paintEach(count, (i) => colour(classFrom[i])), legend: { kind: "categories", entries } };
}

function paintCauses(causes: ArrayLike<number>, names: readonly string[]): Painting {
  const colour = (cause: number): Rgb => (cause > 0 ? CATEGORIES[(cause - 1) % CATEGORIES.length] : ABSENT_RGB);
  const entries = names.map((name, cause) => [name === "" ? "none" : name, colour(cause)] as const);
  return { colours: paintEach(causes.length, (i) => colour(causes[i])), legend: { kind: "categories", entries } };
}

function paintRadars(cloud: Cloud): Painting {
  const radars = [...new Set(cloud.scans.map(({ radar }) => radar))].sort();
  const colour = (radar: string): Rgb => CATEGORIES[radars.indexOf(radar) % CATEGORIES.length];
  const ofScan = cloud.scans.map(({ radar }) => colour(radar));
  const entries = radars.map((radar) => [radar, colour(radar)] as const);
  return { colours: paintEach(cloud.count, (i) => ofScan[cloud.scanOf[i]]), legend: { kind: "categories", entries } };
}

/** A column as its kind wants it: shares from 0 to 1, velocities around 0, anything else over most of its values. */
function paintColumn(cloud: Cloud, name: string): Painting {
  const values = gather(cloud, name);
  const info = columnsOf(cloud).find((column) => column.name === name);
  if (info?.group === "plausibility") return paintScale(values, 0, 1, info.unit, viridis);
  if (info?.unit === "m/s") return paintScale(values, -VELOCITY_END, VELOCITY_END, info.unit, diverging);
  const sorted = values.filter((value) => !Number.isNaN(value)).sort();
  // Some values are far larger than the rest; the map spans nine tenths of them.
  const at = (share: number): number => sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
  const least = Math.floor(at(0.05));
  return paintScale(values, least, Math.max(Math.ceil(at(0.95)), least + 1), info?.unit ?? "", viridis);
}

function paintAge(cloud: Cloud): Painting {
  const times = cloud.scans.map(({ table }) => BigInt(table.header.t_ns));
  const seconds = times.map((time) => Number(time - times[0]) * 1e-9);
  const end = Math.max(...seconds.map(Math.abs), 1e-3);
  const values = new Float32Array(cloud.count).map((_, i) => seconds[cloud.scanOf[i]]);
  return paintScale(values, -end, end, "s", diverging);
}

function paintScale(
  values: Float32Array,
  least: number,
  most: number,
  unit: string,
  map: (share: number) => Rgb,
): Painting {
  const colour = (value: number): Rgb => (Number.isNaN(value) ? ABSENT_RGB : map((value - least) / (most - least)));
  return {
    colours: paintEach(values.length, (i) => colour(values[i])),
    legend: { kind: "scale", least, most, unit, map },
  };
}
