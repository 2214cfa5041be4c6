/** Labels of the range rings, the axes, and the bar that shows how long a stretch on screen is. */

import { textScale } from "../dom.js";
import { RINGS } from "./ground.js";

const FAINT = "#7d8898";
/** The height of letters, px. */
const LETTERS = 11;

/** The roundest length (1, 2 or 5 times a power of ten) that is no longer than `most`. */
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  const times = [5, 2, 1].find((factor) => factor * power <= most) ?? 1;
  return times * power;
}

export function drawScaleBar(
  context: CanvasRenderingContext2D,
  metresPerPixel: number,
  width: number,
  height: number,
): void {
  const metres = roundLength(140 * metresPerPixel);
  const length = metres / metresPerPixel;
  const [right, bottom] = [width - 18, height - 18];
  context.strokeStyle = "#c9d2de";
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(right - length, bottom - 5);
  context.lineTo(right - length, bottom);
  context.lineTo(right, bottom);
  context.lineTo(right, bottom - 5);
  context.stroke();
  text(context, `${metres} m`, right - length / 2, bottom - 8, "center", "#c9d2de");
}

/** Writes the rings' ranges along the forward axis, left of it, where they aren't crowded. */
export function drawRingLabels(
  context: CanvasRenderingContext2D,
  project: (positions: Float32Array) => Float32Array,
): void {
  const places = project(new Float32Array(RINGS.flatMap((range) => [range, 0, 0])));
  let last = Infinity;
  RINGS.forEach((range, i) => {
    const [x, y] = [places[2 * i], places[2 * i + 1]];
    if (Number.isNaN(x) || last - y < 22) return;
    last = y;
    text(context, `${range} m`, x + 5, y - 4, "left", FAINT);
  });
}

/** Small arrows in the lower left: x forward, y left. */
export function drawAxes(context: CanvasRenderingContext2D, height: number): void {
  const [x, y, length] = [48, height - 24, 26];
  context.strokeStyle = FAINT;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x - length, y);
  context.lineTo(x, y);
  context.lineTo(x, y - length);
  context.stroke();
  text(context, "x", x + 5, y - length + 6, "left", FAINT);
  text(context, "y", x - length - 10, y + 4, "left", FAINT);
}

function text(
  context: CanvasRenderingContext2D,
  words: string,
  x: number,
  y: number,
  align: CanvasTextAlign,
  colour: string,
): void {
  context.font = `${LETTERS * textScale()}px system-ui, sans-serif`;
  context.textAlign = align;
  context.lineWidth = 3;
  context.strokeStyle = "rgb(11 14 19 / 80%)";
  context.strokeText(words, x, y);
  context.fillStyle = colour;
  context.fillText(words, x, y);
}
