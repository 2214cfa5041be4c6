/** A filter as JSON, to be kept in the browser, and taken back. */

import { areasFrom } from "./area.js";
import { type ColumnSpan, everything, type Filter, type Origin, type Span } from "./filter.js";

/** A filter as JSON can hold it; `filterFrom` takes it back. */
export function plainFilter(filter: Filter): object {
  const columns = filter.columns.map(({ name, span }) => ({
    name,
    span: span.map((end) => (isFinite(end) ? end : null)),
  }));
  const { classes, classFrom, hiddenRadars } = filter;
  const sets = { classes: [...classes], classFrom: [...classFrom], hiddenRadars: [...hiddenRadars] };
  return { ...filter, ...sets, columns };
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
    classes: numbersFrom(found["classes"]),
    classFrom: numbersFrom(found["classFrom"]),
    hiddenRadars: new Set(Array.isArray(found["hiddenRadars"]) ? found["hiddenRadars"].map(String) : []),
    columns: columnsFrom(found["columns"]),
    areas: areasFrom(found["areas"]),
  };
}

function numbersFrom(kept: unknown): ReadonlySet<number> {
  const all: readonly unknown[] = Array.isArray(kept) ? kept : [];
  return new Set(all.filter((one) => typeof one === "number"));
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
