/** How a person looks at a dataset: colours, filters and the like, kept in the browser over a reload. */

import { filterFrom, plainFilter } from "./data/kept-filter.js";
import type { State } from "./state.js";
import type { Store } from "./store.js";

const KEPT = [
  "colour",
  "filter",
  "lidarShown",
  "groundHidden",
  "lidarInImages",
  "light",
  "dotSize",
  "queueView",
] as const;
type Preferences = Pick<State, (typeof KEPT)[number]>;

/** Takes up what was kept of the dataset, and keeps every change from now on. */
export function keepPreferences(store: Store<State>): void {
  const key = `ralf-view ${store.state.recording.dataset}`;
  store.set(read(localStorage.getItem(key), store.state));
  store.watch(
    (state) => KEPT.map((name) => state[name]),
    () => localStorage.setItem(key, writtenPreferences(store.state)),
  );
}

export function writtenPreferences(state: Preferences): string {
  const { colour, lidarShown, groundHidden, lidarInImages, light, dotSize, queueView } = state;
  const filter = plainFilter(state.filter);
  return JSON.stringify({ colour, lidarShown, groundHidden, lidarInImages, light, dotSize, queueView, filter });
}

/** What is kept as far as it makes sense; the rest is as it is. */
export function read(text: string | null, now: Preferences): Partial<Preferences> {
  let kept: unknown = null;
  try {
    kept = JSON.parse(text ?? "null");
  } catch {
    return {};
  }
  if (typeof kept !== "object" || kept === null) return {};
  const found = kept as Record<string, unknown>;
  const same = <Name extends keyof Preferences>(name: Name): Partial<Preferences> =>
    typeof found[name] === typeof now[name] ? { [name]: found[name] } : {};
  return {
    ...same("colour"),
    ...same("lidarShown"),
    ...same("groundHidden"),
    ...same("lidarInImages"),
    ...same("light"),
    ...same("dotSize"),
    queueView: { ...now.queueView, ...(found["queueView"] as object | undefined) },
    filter: filterFrom(found["filter"]),
  };
}
