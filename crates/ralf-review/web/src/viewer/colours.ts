/** What a detection's colour says, and the legend to it. */

import type { Recording } from "../api/types.js";
import { gather, type Cloud } from "../data/cloud.js";
import type { LabelBook, Truth } from "../data/labels.js";
import {
  ABSENT_RGB,
  ARTIFACT_RGB,
  CATEGORIES,
  diverging,
  PLAUSIBLE_RGB,
  type Rgb,
  UNLABELLED_RGB,
  viridis,
} from "./palette.js";

export const COLOUR_MODES = [
  ["label", "Label"],
  ["class", "Class"],
  ["w", "Plausibility w"],
  ["w_lm", "w LiDAR"],
  ["w_cm", "w camera"],
  ["w_opt", "w optical"],
  ["w_tr", "w tracking"],
  ["doppler", "Doppler"],
  ["power", "Power"],
  ["cause", "Cause"],
  ["radar", "Radar"],
  ["height", "Height"],
  ["age", "Time"],
] as const;

export type ColourMode = (typeof COLOUR_MODES)[number][0];

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

/** Names under which the strength of the echo comes, and its unit. */
const POWER_FIELDS: readonly (readonly [name: string, unit: string])[] = [
  ["power", "dB"],
  ["rcs", "dBsm"],
  ["snr", "dB"],
  ["RCS", "dBsm"],
];
const DOPPLER_FIELDS = ["doppler_compensated", "doppler"] as const;
/** Doppler velocities beyond this have the map's ends, m/s. */
const DOPPLER_END = 10;

export function truthColour(truth: Truth): Rgb {
  return TRUTH_COLOURS[truth];
}

export function paint(cloud: Cloud, mode: ColourMode, labels: LabelBook, recording: Recording): Painting {
  switch (mode) {
    case "label":
      return paintLabels(cloud, labels);
    case "class":
      return paintClasses(cloud, labels);
    case "cause":
      return paintCauses(cloud, recording.causes ?? []);
    case "radar":
      return paintRadars(cloud);
    case "doppler":
      return paintScale(firstKnown(cloud, DOPPLER_FIELDS), -DOPPLER_END, DOPPLER_END, "m/s", diverging);
    case "power":
      return paintPower(cloud);
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
      return paintScale(gather(cloud, mode), 0, 1, "", viridis);
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

function paintClasses(cloud: Cloud, labels: LabelBook): Painting {
  const clusters = [...new Set(labels.classes.map(({ cluster }) => cluster))].filter(
    (name) => name !== null && name !== "artifact",
  );
  const ofCluster = new Map(clusters.map((name, index) => [name, CATEGORIES[(index + 2) % CATEGORIES.length]]));
  const colour = (id: number): Rgb => ofCluster.get(labels.cluster(id)) ?? TRUTH_COLOURS[labels.truth(id)];
  const entries: (readonly [string, Rgb])[] = [
    ["plausible", PLAUSIBLE_RGB],
    ["artifact", ARTIFACT_RGB],
  ];
  for (const [name, rgb] of ofCluster) entries.push([name ?? "", rgb]);
  return { colours: paintEach(cloud.count, (i) => colour(cloud.label[i])), legend: { kind: "categories", entries } };
}

function paintCauses(cloud: Cloud, names: readonly string[]): Painting {
  const causes = gather(cloud, "cause");
  const colour = (cause: number): Rgb => (cause > 0 ? CATEGORIES[(cause - 1) % CATEGORIES.length] : ABSENT_RGB);
  const entries = names.map((name, cause) => [name === "" ? "none" : name, colour(cause)] as const);
  return { colours: paintEach(cloud.count, (i) => colour(causes[i])), legend: { kind: "categories", entries } };
}

function paintRadars(cloud: Cloud): Painting {
  const radars = [...new Set(cloud.scans.map(({ radar }) => radar))].sort();
  const colour = (radar: string): Rgb => CATEGORIES[radars.indexOf(radar) % CATEGORIES.length];
  const ofScan = cloud.scans.map(({ radar }) => colour(radar));
  const entries = radars.map((radar) => [radar, colour(radar)] as const);
  return { colours: paintEach(cloud.count, (i) => ofScan[cloud.scanOf[i]]), legend: { kind: "categories", entries } };
}

function paintPower(cloud: Cloud): Painting {
  const known =
    POWER_FIELDS.find(([name]) => cloud.scans.some(({ table }) => table.columns.has(name))) ?? POWER_FIELDS[0];
  const values = gather(cloud, known[0]);
  const sorted = values.filter((value) => !Number.isNaN(value)).sort();
  // Some echoes are far stronger than the rest; the map spans nine tenths of them.
  const at = (share: number): number => sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
  const least = Math.floor(at(0.05));
  return paintScale(values, least, Math.max(Math.ceil(at(0.95)), least + 1), known[1], viridis);
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

function firstKnown(cloud: Cloud, names: readonly string[]): Float32Array {
  const name = names.find((field) => cloud.scans.some(({ table }) => table.columns.has(field)));
  return gather(cloud, name ?? names[0]);
}
