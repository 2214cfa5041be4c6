/** How an image lies in its element: pixels of the image to CSS pixels. Pixel centres of images lie at integers. */

import type { Point } from "../selection/geometry.js";

export interface Frame {
  readonly scale: number;
  readonly left: number;
  readonly top: number;
}

type Size = readonly [width: number, height: number];

const MOST_SCALE = 40;
const LEAST_SCALE = 0.05;

/** The whole image, as large as it fits, in the middle. */
export function fitted(image: Size, element: Size): Frame {
  const scale = Math.min(element[0] / image[0], element[1] / image[1]);
  return { scale, left: (element[0] - image[0] * scale) / 2, top: (element[1] - image[1] * scale) / 2 };
}

/** Larger or smaller, with what is under the pointer staying there. */
export function zoomedAt({ scale, left, top }: Frame, factor: number, [x, y]: Point): Frame {
  const wanted = Math.min(Math.max(scale * factor, LEAST_SCALE), MOST_SCALE);
  const ratio = wanted / scale;
  return { scale: wanted, left: x - (x - left) * ratio, top: y - (y - top) * ratio };
}

export function movedBy(frame: Frame, right: number, down: number): Frame {
  return { ...frame, left: frame.left + right, top: frame.top + down };
}

/** u, v, u, v, ... to CSS pixels; NaN stays NaN. */
export function toScreen({ scale, left, top }: Frame, places: Float32Array): Float32Array {
  return places.map((value, i) => (value + 0.5) * scale + (i % 2 === 0 ? left : top));
}
