/** Numbers with their names, in columns as wide as the names want. */

import type { NumberColumn } from "../data/cloud.js";
import { h } from "../dom.js";
import { decimal, degrees } from "../format.js";

/** Longer names don't fit beside another one. */
const LONGEST_BESIDE = 12;
/** Before the name of a group of evidence: what it adds to the log odds. */
const REASON = "reason_";

export function fact(name: string, value: string, meaning = ""): HTMLElement[] {
  const title = meaning === "" ? name : `${name}: ${meaning}`;
  return [h("dt", { title }, name), h("dd", { class: "number" }, value)];
}

/** Lists of what columns hold: those with short names side by side, and a model's reasons under a heading. */
export function numbersOf(columns: readonly NumberColumn[], value: (name: string) => number): HTMLElement[] {
  const reasons = columns.filter(({ name }) => name.startsWith(REASON));
  const others = columns.filter(({ name }) => !name.startsWith(REASON));
  const isShort = ({ name }: NumberColumn): boolean => name.length <= LONGEST_BESIDE;
  const told = ({ name, unit, meaning }: NumberColumn): HTMLElement[] =>
    fact(name, measured(value(name), unit), meaning);
  const why = ({ name, meaning }: NumberColumn): HTMLElement[] =>
    fact(name.slice(REASON.length).replaceAll("_", " "), measured(value(name), ""), meaning);
  return [
    h("dl", { class: "facts" }, ...others.filter(isShort).flatMap(told)),
    h("dl", { class: "facts words" }, ...others.filter((column) => !isShort(column)).flatMap(told)),
    ...(reasons.length === 0 ? [] : [h("h3", {}, `Reasons, ${reasons[0].unit}`)]),
    h("dl", { class: "facts words" }, ...reasons.flatMap(why)),
  ];
}

function measured(value: number, unit: string): string {
  if (unit === "rad") return degrees(value);
  return unit === "" || !Number.isFinite(value) ? decimal(value, 2) : `${decimal(value, 2)} ${unit}`;
}
