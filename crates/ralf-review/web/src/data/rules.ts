/** Filters with a name, kept in the browser for every recording: what was asked of one sequence is asked of others. */

import type { Cloud } from "./cloud.js";
import type { Filter } from "./filter.js";
import { filterFrom, plainFilter } from "./kept-filter.js";

const KEY = "ralf-rules";

/** What a rule says of what it lets through. */
export interface Verdict {
  readonly label: number;
  /** Why it is an artifact. */
  readonly cause: string | null;
}

export interface Rule {
  readonly name: string;
  readonly filter: Filter;
  /** `null`: it only chooses. */
  readonly sets: Verdict | null;
}

/** The rules that a text holds, as far as it makes sense, by name. */
export function rulesFrom(text: string | null): readonly Rule[] {
  try {
    const kept: unknown = JSON.parse(text ?? "{}");
    if (typeof kept !== "object" || kept === null) return [];
    return Object.entries(kept)
      .map(([name, rule]) => ({ name, filter: filterFrom(rule), sets: verdictFrom(rule) }))
      .sort((a, b) => a.name.localeCompare(b.name));
  } catch {
    return [];
  }
}

function verdictFrom(kept: unknown): Verdict | null {
  const { sets } = (kept ?? {}) as { readonly sets?: { readonly label?: unknown; readonly cause?: unknown } | null };
  if (typeof sets?.label !== "number") return null;
  return { label: sets.label, cause: typeof sets.cause === "string" ? sets.cause : null };
}

/** A verdict as a choice in a list has it: `1/mirror`, `99`; `verdictOf` takes it back, nothing of an empty text. */
export function verdictText(sets: Verdict | null): string {
  return sets === null ? "" : sets.cause === null ? String(sets.label) : `${sets.label}/${sets.cause}`;
}

export function verdictOf(text: string): Verdict | null {
  const [label, cause] = text.split("/");
  return label === "" ? null : { label: Number(label), cause: cause ?? null };
}

/** Whether a detection is already what a verdict says. */
export function isAlready(cloud: Cloud, i: number, { label, cause }: Verdict, causes: readonly string[]): boolean {
  return cloud.label[i] === label && (cause === null || causes[cloud.saidCause[i]] === cause);
}

/** How many of the chosen detections a verdict leaves as they are. */
export function countAlready(cloud: Cloud, chosen: Uint8Array, sets: Verdict, causes: readonly string[]): number {
  return chosen.reduce((sum, one, i) => sum + (one === 1 && isAlready(cloud, i, sets, causes) ? 1 : 0), 0);
}

export function rulesText(rules: readonly Rule[]): string {
  const kept = rules.map(({ name, filter, sets }) => [name, { ...plainFilter(filter), sets }] as const);
  return JSON.stringify(Object.fromEntries(kept));
}

export function readRules(): readonly Rule[] {
  return rulesFrom(localStorage.getItem(KEY));
}

export function keepRules(rules: readonly Rule[]): void {
  localStorage.setItem(KEY, rulesText(rules));
}
