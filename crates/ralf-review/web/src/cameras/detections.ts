/** Detections as dots on a 2D canvas. */

import type { Cloud } from "../data/cloud.js";
import { cssColour, SELECTED_RGB, WAITING_RGB } from "../viewer/palette.js";

/** A broken rim: told by its shape, whatever colours one sees. */
function drawWaiting(context: CanvasRenderingContext2D): void {
  context.setLineDash([2.5, 2.5]);
  context.lineWidth = 2;
  context.strokeStyle = cssColour(WAITING_RGB);
  context.stroke();
  context.setLineDash([]);
}

export interface Dots {
  readonly cloud: Cloud;
  readonly colours: Uint8Array;
  readonly shown: Uint8Array;
  readonly eligible: Uint8Array;
  readonly selection: Uint8Array;
  /** Those of strokes that aren't saved yet. */
  readonly waiting: Uint8Array;
}

const RIM = "rgb(5 8 12 / 80%)";
const CORRECTED_RIM = "#ffffff";

/** What can't be changed, the rest, the selected: drawn in this order. */
export const LAYERS = [0, 1, 2] as const;

/** Draws those layers of what is shown. */
export function drawDetections(
  context: CanvasRenderingContext2D,
  places: Float32Array,
  dots: Dots,
  radius: number,
  layers: readonly number[],
): void {
  for (const layer of layers) {
    context.globalAlpha = layer === 0 ? 0.3 : 0.95;
    for (let i = 0; i < dots.cloud.count; i++) {
      if (dots.shown[i] === 0 || Number.isNaN(places[2 * i])) continue;
      if (dots.eligible[i] + dots.selection[i] === layer) drawDot(context, places, dots, i, radius);
    }
  }
  context.globalAlpha = 1;
}

function drawDot(context: CanvasRenderingContext2D, places: Float32Array, dots: Dots, i: number, radius: number): void {
  const selected = dots.selection[i] === 1;
  const size = radius * (selected ? 1.3 : dots.eligible[i] === 1 ? 1 : 0.7);
  const { colours } = dots;
  context.beginPath();
  context.arc(places[2 * i], places[2 * i + 1], size, 0, 2 * Math.PI);
  context.fillStyle = cssColour([colours[3 * i], colours[3 * i + 1], colours[3 * i + 2]]);
  context.fill();
  if (!selected && dots.waiting[i] === 1) return drawWaiting(context);
  context.lineWidth = selected ? 2 : 1;
  context.strokeStyle = selected ? cssColour(SELECTED_RGB) : dots.cloud.corrected[i] === 1 ? CORRECTED_RIM : RIM;
  context.stroke();
}
