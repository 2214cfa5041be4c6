/** Which class a detection has, and who tells it. */

import type { Recording } from "../api/types.js";
import { isClass } from "./labels.js";
import type { Scan } from "./scan.js";

/** No class, so nobody tells it. */
export const UNTOLD = 0;
/** A person said the class, or accepted it; lower numbers are places in the recording's `class_sources`. */
export const BY_PERSON = 255;

/** Who tells the class of a detection's label: what a person says, or once accepted, is theirs. */
export function classSource({ label, machine, corrected, classFrom }: Scan, point: number): number {
  if (!isClass(label[point])) return UNTOLD;
  return corrected[point] === 1 || label[point] !== machine[point] ? BY_PERSON : classFrom[point];
}

export function sourceName(source: number, { class_sources: names }: Pick<Recording, "class_sources">): string {
  if (source === BY_PERSON) return "a person";
  return source === UNTOLD ? "no class" : (names[source] ?? `source ${source}`);
}

/** Everything that may tell a class, in the order of its say; last that there is none. */
export function allSources({ class_sources: names }: Pick<Recording, "class_sources">): readonly number[] {
  return [BY_PERSON, ...names.map((_, source) => source).filter((source) => source !== UNTOLD), UNTOLD];
}

/** The numbers that occur, the smallest first. */
export function present(numbers: Iterable<number>): readonly number[] {
  return [...new Set(numbers)].sort((a, b) => a - b);
}
