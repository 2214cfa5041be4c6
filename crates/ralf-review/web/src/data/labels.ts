/** What label ids mean. */

import type { LabelClass } from "../api/types.js";

export const UNLABELLED = 0;
export const ARTIFACT = 1;
export const PLAUSIBLE = 99;

/** What a person sets: a label, or `null` for the machine's own guess. */
export type Choice = number | null;

export type Truth = "plausible" | "artifact" | "unlabelled";

/** Whether a label says more than whether a detection is plausible. */
export function isClass(id: number): boolean {
  return ![UNLABELLED, ARTIFACT, PLAUSIBLE].includes(id);
}

export class LabelBook {
  private readonly byId: ReadonlyMap<number, LabelClass>;

  constructor(readonly classes: readonly LabelClass[]) {
    this.byId = new Map(classes.map((entry) => [entry.id, entry]));
  }

  /** An id that isn't in the list is a plausible class of somebody else's. */
  truth(id: number): Truth {
    if (id === UNLABELLED) return "unlabelled";
    return this.byId.get(id)?.plausible === false ? "artifact" : "plausible";
  }

  name(id: number): string {
    if (id === ARTIFACT) return "artifact";
    if (id === PLAUSIBLE) return "plausible";
    return this.byId.get(id)?.name ?? `class ${id}`;
  }

  /** With why it is an artifact, or who tells its class, where that is known. */
  nameWith(id: number, more: string | null): string {
    return this.name(id) + (more === null ? "" : ` (${more})`);
  }

  cluster(id: number): string | null {
    return this.byId.get(id)?.cluster ?? null;
  }

  choiceName(choice: Choice): string {
    return choice === null ? "machine's guess" : this.name(choice);
  }
}

/** The classes whose name, cluster or id contain what was typed; those that begin with it first. */
export function searchClasses(classes: readonly LabelClass[], typed: string): readonly LabelClass[] {
  const wanted = typed.trim().toLowerCase();
  const rank = ({ id, name, cluster }: LabelClass): number => {
    if (name.startsWith(wanted) || String(id) === wanted) return 0;
    if (name.includes(wanted)) return 1;
    return cluster?.includes(wanted) === true ? 2 : 3;
  };
  return classes
    .map((entry) => ({ entry, rank: rank(entry) }))
    .filter((found) => found.rank < 3)
    .sort((a, b) => a.rank - b.rank)
    .map((found) => found.entry);
}
