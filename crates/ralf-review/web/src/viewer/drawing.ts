/** Drawing on a 2D canvas in CSS pixels: the tools' shapes, rings around detections, crisp text. */

import type { Point, Shape } from "../selection/geometry.js";
import { CLOSING_REACH, type Gesture, shapeOf } from "../selection/tools.js";

const LINE = "#5eeaa6";
const AREA = "#f5c451";
const FILL = "rgb(94 234 166 / 12%)";

/** Fits a canvas to its element; returns its context in CSS pixels, wiped. */
export function cleared(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D | null {
  const ratio = Math.min(window.devicePixelRatio, 2);
  const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
  const context = canvas.getContext("2d");
  context?.setTransform(ratio, 0, 0, ratio, 0, 0);
  context?.clearRect(0, 0, width, height);
  return context;
}

export function drawGesture(context: CanvasRenderingContext2D, gesture: Gesture, brush: number): void {
  context.strokeStyle = LINE;
  context.fillStyle = FILL;
  context.lineWidth = 1.5;
  const shape = shapeOf(gesture, brush);
  if (gesture.tool === "polygon") drawPolygonTool(context, gesture);
  else if (shape !== null) drawShape(context, shape);
}

export function drawBrushCursor(context: CanvasRenderingContext2D, [x, y]: Point, radius: number): void {
  context.strokeStyle = LINE;
  context.lineWidth = 1.5;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
}

/** The ring around the detection under the pointer. */
export function drawHover(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  for (const [width, colour] of [
    [4, "rgb(0 0 0 / 65%)"],
    [2, "#ffffff"],
  ] as const) {
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.stroke();
  }
}

/** Outlines and surfaces that a filter asks for; what isn't all in the picture is left out. */
export function drawAreas(context: CanvasRenderingContext2D, areas: readonly (readonly Point[])[]): void {
  context.strokeStyle = AREA;
  context.lineWidth = 2;
  for (const corners of areas.filter((area) => area.every(([x]) => !Number.isNaN(x)))) {
    context.beginPath();
    trace(context, corners);
    if (corners.length > 2) context.closePath();
    context.stroke();
  }
}

function drawShape(context: CanvasRenderingContext2D, shape: Shape): void {
  context.beginPath();
  if (shape.kind === "box") {
    const [[x0, y0], [x1, y1]] = [shape.from, shape.to];
    context.rect(x0, y0, x1 - x0, y1 - y0);
  } else if (shape.kind === "polygon") {
    trace(context, shape.corners);
    context.closePath();
  } else {
    return drawBrushPath(context, shape.path, shape.radius);
  }
  context.fill();
  context.stroke();
}

function drawBrushPath(context: CanvasRenderingContext2D, path: readonly Point[], radius: number): void {
  context.save();
  context.lineWidth = 2 * radius;
  context.lineCap = "round";
  context.lineJoin = "round";
  context.strokeStyle = FILL;
  context.beginPath();
  trace(context, path.length === 1 ? [path[0], path[0]] : path);
  context.stroke();
  context.restore();
  drawBrushCursor(context, path[path.length - 1], radius);
}

function drawPolygonTool(context: CanvasRenderingContext2D, { path, pointer }: Gesture): void {
  context.beginPath();
  trace(context, [...path, pointer]);
  context.closePath();
  context.fill();
  context.beginPath();
  trace(context, [...path, pointer]);
  context.stroke();
  context.beginPath();
  context.arc(path[0][0], path[0][1], path.length >= 3 ? CLOSING_REACH : 3, 0, 2 * Math.PI);
  context.stroke();
}

function trace(context: CanvasRenderingContext2D, path: readonly Point[]): void {
  path.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
}
