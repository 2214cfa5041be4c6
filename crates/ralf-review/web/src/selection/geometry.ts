/** Plane geometry of the tools, in pixels. Places come as x, y, x, y, ...; NaN for what isn't in the picture. */

export type Point = readonly [x: number, y: number];

export type Shape =
  | { readonly kind: "box"; readonly from: Point; readonly to: Point }
  | { readonly kind: "polygon"; readonly corners: readonly Point[] }
  | { readonly kind: "stroke"; readonly path: readonly Point[]; readonly radius: number };

/** Whether a place lies in a polygon, by the even-odd rule; the last corner is joined to the first. */
export function insidePolygon(corners: readonly Point[], [x, y]: Point): boolean {
  let inside = false;
  for (let i = 0, j = corners.length - 1; i < corners.length; j = i++) {
    const [xi, yi] = corners[i];
    const [xj, yj] = corners[j];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

/** How far a place is from the stretch between two others. */
export function distanceToSegment([x, y]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay];
  const length = dx * dx + dy * dy;
  const along = length === 0 ? 0 : Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / length, 0), 1);
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}

/** Whether a place lies in a shape; its border counts for boxes and strokes. */
export function contains(shape: Shape, place: Point): boolean {
  switch (shape.kind) {
    case "box":
      return between(place[0], shape.from[0], shape.to[0]) && between(place[1], shape.from[1], shape.to[1]);
    case "polygon":
      return insidePolygon(shape.corners, place);
    case "stroke":
      return nearPath(shape.path, place, shape.radius);
  }
}

/** Sets 1 in `mask` for each eligible place in the shape. */
export function collect(shape: Shape, places: Float32Array, eligible: Uint8Array, mask: Uint8Array): void {
  for (let i = 0; i < eligible.length; i++) {
    const [x, y] = [places[2 * i], places[2 * i + 1]];
    if (eligible[i] === 1 && !Number.isNaN(x) && contains(shape, [x, y])) mask[i] = 1;
  }
}

/** The eligible place nearest to `at` and no farther than `reach`, or -1. */
export function nearest(places: Float32Array, eligible: Uint8Array, [x, y]: Point, reach: number): number {
  let found = -1;
  let least = reach * reach;
  for (let i = 0; i < eligible.length; i++) {
    if (eligible[i] === 0) continue;
    const [dx, dy] = [places[2 * i] - x, places[2 * i + 1] - y];
    const distance = dx * dx + dy * dy;
    if (distance <= least) {
      least = distance;
      found = i;
    }
  }
  return found;
}

function nearPath(path: readonly Point[], place: Point, radius: number): boolean {
  if (path.length === 1) return distanceToSegment(place, path[0], path[0]) <= radius;
  return path.some((corner, i) => i > 0 && distanceToSegment(place, path[i - 1], corner) <= radius);
}

function between(value: number, a: number, b: number): boolean {
  return value >= Math.min(a, b) && value <= Math.max(a, b);
}
