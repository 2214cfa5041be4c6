/** Filters with a name, kept in the browser for every recording: what was asked of one sequence is asked of others. */

import type { Filter } from "./filter.js";
import { filterFrom, plainFilter } from "./kept-filter.js";

const KEY = "ralf-rules";

export interface Rule {
  readonly name: string;
  readonly filter: Filter;
}

/** The rules that a text holds, as far as it makes sense, by name. */
export function rulesFrom(text: string | null): readonly Rule[] {
  try {
    const kept: unknown = JSON.parse(text ?? "{}");
    if (typeof kept !== "object" || kept === null) return [];
    return Object.entries(kept)
      .map(([name, filter]) => ({ name, filter: filterFrom(filter) }))
      .sort((a, b) => a.name.localeCompare(b.name));
  } catch {
    return [];
  }
}

export function rulesText(rules: readonly Rule[]): string {
  return JSON.stringify(Object.fromEntries(rules.map(({ name, filter }) => [name, plainFilter(filter)])));
}

export function readRules(): readonly Rule[] {
  return rulesFrom(localStorage.getItem(KEY));
}

export function keepRules(rules: readonly Rule[]): void {
  localStorage.setItem(KEY, rulesText(rules));
}
