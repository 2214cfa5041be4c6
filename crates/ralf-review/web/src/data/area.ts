/** Places of the world that a filter asks for: inside an outline, behind a surface, what a surface mirrors. */

import { insidePolygon, type Point } from "../selection/geometry.js";
import type { Cloud } from "./cloud.js";
import type { LabelBook } from "./labels.js";
import { movePlace, place, targetFromSource } from "./transform.js";

export const AREAS = ["inside", "behind", "mirror"] as const;
export type AreaKind = (typeof AREAS)[number];

/** Whose odometry frame it is: many recordings have a sequence 00. */
export interface Home {
  readonly dataset: string;
  readonly sequence: string;
}

export interface Area extends Home {
  readonly kind: AreaKind;
  /** An outline's corners, or the two ends of a surface, x, y in the odometry frame, m. */
  readonly corners: readonly Point[];
}

/** How near to something plausible a mirror image lies, m. */
const MIRRORED_WITHIN = 1;
/** Corners nearer to each other than this tell nothing, m. */
const LEAST_SIDE = 0.1;

/** The area that was drawn, as a path in the frame of the scan under review; `null` where it has no extent. */
export function areaOf(kind: AreaKind, path: readonly Point[], cloud: Cloud, home: Home): Area | null {
  const from = cloud.scans[0]?.table.header.odom_from_vehicle ?? null;
  const apart = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const steps = path.filter((point, i) => i === 0 || apart(point, path[i - 1]) > 0);
  const drawn = kind === "inside" ? steps : [steps[0], steps[steps.length - 1]];
  if (steps.length < (kind === "inside" ? 3 : 2) || !drawn.some((point) => apart(point, drawn[0]) > LEAST_SIDE))
    return null;
  const corners = drawn.map(([x, y]): Point => {
    const [ox, oy] = from === null ? [x, y] : place(from, [x, y, 0]);
    return [ox, oy];
  });
  return { kind, ...home, corners };
}

export function liesIn(area: Area, { dataset, sequence }: Home): boolean {
  return area.dataset === dataset && area.sequence === sequence;
}

/** The corners in the frame of the scan under review. */
export function cornersHere({ corners }: Area, cloud: Cloud): readonly Point[] {
  const from = cloud.scans[0]?.table.header.odom_from_vehicle ?? null;
  return corners.map(([x, y]): Point => {
    const [vx, vy] = movePlace(from, [x, y, from?.[11] ?? 0]);
    return [vx, vy];
  });
}

/**
 * 1 for each detection that lies in all of the areas, where it was measured, whatever is held still; those of another
 * sequence have nothing in them.
 */
export function inAreas(cloud: Cloud, areas: readonly Area[], home: Home, labels: LabelBook): Uint8Array {
  const inside = new Uint8Array(cloud.count).fill(1);
  for (const area of areas) {
    const has = liesIn(area, home) ? asked(area, cloud, labels) : (): boolean => false;
    for (let i = 0; i < cloud.count; i++) {
      const at: Point = [cloud.measured[3 * i], cloud.measured[3 * i + 1]];
      if (inside[i] === 1 && !has(at, i)) inside[i] = 0;
    }
  }
  return inside;
}

function asked(area: Area, cloud: Cloud, labels: LabelBook): (at: Point, index: number) => boolean {
  const corners = cornersHere(area, cloud);
  if (area.kind === "inside") return (at) => insidePolygon(corners, at);
  const [a, b] = corners;
  const eyes = origins(cloud);
  const behind = (at: Point, index: number): boolean => crosses(eyes[cloud.scanOf[index]], at, a, b);
  if (area.kind === "behind") return behind;
  const plausible = plausibleCells(cloud, labels, behind);
  return (at, index) => behind(at, index) && plausible(mirrored(at, a, b));
}

/** Where the radar of each scan was, in the frame of the scan under review. */
function origins({ scans }: Cloud): readonly Point[] {
  const target = scans[0]?.table.header.odom_from_vehicle ?? null;
  return scans.map(({ table }): Point => {
    const { odom_from_vehicle: source, origin } = table.header;
    const [x, y] = place(targetFromSource(target, source), origin);
    return [x, y];
  });
}

/** Whether the way from one place to another crosses a line between two others. */
export function crosses(from: Point, to: Point, a: Point, b: Point): boolean {
  const side = (p: Point, q: Point, r: Point): number => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  return side(a, b, from) * side(a, b, to) < 0 && side(from, to, a) * side(from, to, b) < 0;
}

/** The mirror image of a place at the line through two others. */
export function mirrored([x, y]: Point, a: Point, b: Point): Point {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const along = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy);
  return [2 * (a[0] + along * dx) - x, 2 * (a[1] + along * dy) - y];
}

/** Whether something plausible that isn't behind the surface lies near a place. */
function plausibleCells(
  cloud: Cloud,
  labels: LabelBook,
  behind: (at: Point, index: number) => boolean,
): (at: Point) => boolean {
  const cells = new Map<string, Point[]>();
  const key = (i: number, j: number): string => `${i},${j}`;
  const cell = (metres: number): number => Math.floor(metres / MIRRORED_WITHIN);
  for (let i = 0; i < cloud.count; i++) {
    const at: Point = [cloud.measured[3 * i], cloud.measured[3 * i + 1]];
    if (labels.truth(cloud.label[i]) !== "plausible" || behind(at, i)) continue;
    const name = key(cell(at[0]), cell(at[1]));
    const there = cells.get(name);
    if (there === undefined) cells.set(name, [at]);
    else there.push(at);
  }
  return ([x, y]) =>
    [-1, 0, 1].some((di) =>
      [-1, 0, 1].some((dj) =>
        (cells.get(key(cell(x) + di, cell(y) + dj)) ?? []).some(
          ([px, py]) => Math.hypot(px - x, py - y) <= MIRRORED_WITHIN,
        ),
      ),
    );
}

/** Areas as far as what was kept makes sense. */
export function areasFrom(kept: unknown): readonly Area[] {
  if (!Array.isArray(kept)) return [];
  return kept.flatMap((one: Partial<Record<keyof Area, unknown>> | null) => {
    const kind = AREAS.find((name) => name === one?.kind);
    const corners = Array.isArray(one?.corners) ? one.corners.filter(isPoint) : [];
    const whole = corners.length >= (kind === "inside" ? 3 : 2);
    return kind !== undefined && typeof one?.dataset === "string" && typeof one.sequence === "string" && whole
      ? [{ kind, dataset: one.dataset, sequence: one.sequence, corners }]
      : [];
  });
}

function isPoint(corner: unknown): corner is Point {
  return Array.isArray(corner) && corner.length === 2 && corner.every((one) => Number.isFinite(one));
}
