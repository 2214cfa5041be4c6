/** Unsaved strokes in the tab's storage: a reload, or the server's end, loses none. */

import type { Pending } from "./outbox.js";

const KEY = "ralf-unsaved-strokes";

export function keepStrokes(waiting: readonly Pending[]): void {
  if (waiting.length === 0) sessionStorage.removeItem(KEY);
  else sessionStorage.setItem(KEY, JSON.stringify(waiting));
}

export function keptStrokes(): readonly Pending[] {
  const text = sessionStorage.getItem(KEY);
  return text === null ? [] : (JSON.parse(text) as readonly Pending[]);
}
