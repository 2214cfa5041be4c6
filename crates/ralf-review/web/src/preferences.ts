/** How a person looks at a dataset: colours, filters and the like, kept in the browser over a reload. */

import { type ColumnSpan, everything, type Filter, type Origin, type Span } from "./data/filter.js";
import type { State } from "./state.js";
import type { Store } from "./store.js";

const KEPT = ["colour", "filter", "lidarShown", "groundHidden", "light", "dotSize", "queueView"] as const;
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
  const { colour, lidarShown, groundHidden, light, dotSize, queueView } = state;
  const filter = plainFilter(state.filter);
  return JSON.stringify({ colour, lidarShown, groundHidden, light, dotSize, queueView, filter });
}

/** A filter as JSON can hold it; `filterFrom` takes it back. */
export function plainFilter(filter: Filter): object {
  const columns = filter.columns.map(({ name, span }) => ({
    name,
    span: span.map((end) => (isFinite(end) ? end : null)),
  }));
  return { ...filter, hiddenRadars: [...filter.hiddenRadars], columns };
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
    ...same("light"),
    ...same("dotSize"),
    queueView: { ...now.queueView, ...(found["queueView"] as object | undefined) },
    filter: filterFrom(found["filter"]),
  };
}

/** A filter as far as what was kept makes sense. */
export function filterFrom(kept: unknown): Filter {
  if (typeof kept !== "object" || kept === null) return everything;
  const found = kept as Record<string, unknown>;
  const flag = (name: "plausible" | "artifact" | "unlabelled" | "uncertain"): boolean =>
    typeof found[name] === "boolean" ? found[name] : everything[name];
  const origin = ["any", "corrected", "machine"].find((name) => name === found["origin"]);
  return {
    plausible: flag("plausible"),
    artifact: flag("artifact"),
    unlabelled: flag("unlabelled"),
    uncertain: flag("uncertain"),
    origin: (origin as Origin | undefined) ?? everything.origin,
    score: spanFrom(found["score"], everything.score),
    range: spanFrom(found["range"], everything.range),
    height: spanFrom(found["height"], everything.height),
    flags: typeof found["flags"] === "number" ? found["flags"] : everything.flags,
    hiddenRadars: new Set(Array.isArray(found["hiddenRadars"]) ? found["hiddenRadars"].map(String) : []),
    columns: columnsFrom(found["columns"]),
  };
}

function columnsFrom(kept: unknown): readonly ColumnSpan[] {
  if (!Array.isArray(kept)) return [];
  return kept.flatMap((one: { readonly name?: unknown; readonly span?: unknown } | null) =>
    typeof one?.name === "string" ? [{ name: one.name, span: spanFrom(one.span, [-Infinity, Infinity]) }] : [],
  );
}

/** JSON knows no infinity: an end that isn't a number is the whole span's. */
function spanFrom(kept: unknown, whole: Span): Span {
  const end = (at: 0 | 1): number => {
    const value: unknown = Array.isArray(kept) ? kept[at] : null;
    return typeof value === "number" ? value : whole[at];
  };
  return [end(0), end(1)];
}
