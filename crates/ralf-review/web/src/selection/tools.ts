/** Gestures of the tools: what the pointer does becomes a shape. Pure: no elements, no state of the page. */

import type { Point, Shape } from "./geometry.js";

export const TOOLS = ["click", "thing", "box", "lasso", "polygon", "brush"] as const;
export type Tool = (typeof TOOLS)[number];

/** Whether a tool chooses what is pressed; dragging moves the picture. */
export function isPress(tool: Tool): boolean {
  return tool === "click" || tool === "thing";
}

/** A gesture under way. */
export interface Gesture {
  readonly tool: Tool;
  readonly path: readonly Point[];
  /** Where the pointer is: a polygon's next corner. */
  readonly pointer: Point;
}

/** Path points closer than this to the last are left out, px. */
const LEAST_STEP = 2;
/** A press this near a polygon's first corner closes it, px. */
export const CLOSING_REACH = 9;

export function begun(tool: Tool, at: Point): Gesture {
  return { tool, path: [at], pointer: at };
}

export function moved(gesture: Gesture, at: Point): Gesture {
  const { tool, path } = gesture;
  if (tool === "polygon") return { ...gesture, pointer: at };
  if (tool === "box" || isPress(tool)) return { ...gesture, path: [path[0], at], pointer: at };
  const last = path[path.length - 1];
  const far = Math.hypot(at[0] - last[0], at[1] - last[1]) >= LEAST_STEP;
  return { ...gesture, path: far ? [...path, at] : path, pointer: at };
}

/** A further press of the polygon tool; `closed` once it came back to its first corner. */
export function pressedAgain(gesture: Gesture, at: Point): { readonly gesture: Gesture; readonly closed: boolean } {
  const first = gesture.path[0];
  const back = Math.hypot(at[0] - first[0], at[1] - first[1]) <= CLOSING_REACH;
  if (back && gesture.path.length >= 3) return { gesture, closed: true };
  return { gesture: { ...gesture, path: [...gesture.path, at], pointer: at }, closed: false };
}

/** The shape a gesture encloses by now; `null` where it has no extent. */
export function shapeOf({ tool, path, pointer }: Gesture, brush: number): Shape | null {
  switch (tool) {
    case "click":
    case "thing":
      return null;
    case "box":
      return path.length < 2 ? null : { kind: "box", from: path[0], to: path[1] };
    case "lasso":
      return path.length < 3 ? null : { kind: "polygon", corners: path };
    case "polygon":
      return path.length < 3 ? null : { kind: "polygon", corners: path };
    case "brush":
      return { kind: "stroke", path: path.length > 0 ? path : [pointer], radius: brush };
  }
}
