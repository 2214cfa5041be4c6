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

/** How much of the image is around a region at least, as a share of its width, and how much larger than it. */
const LEAST_AROUND = 0.16;
const AROUND = 1.8;

export interface Region {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

/** What the chosen places (u, v, u, v, ...) span; `null` where none of them is in the image. */
export function regionOf(places: Float32Array, chosen: Uint8Array): Region | null {
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  chosen.forEach((is, i) => {
    const [u, v] = [places[2 * i], places[2 * i + 1]];
    if (is === 0 || Number.isNaN(u)) return;
    [left, right, top, bottom] = [Math.min(left, u), Math.max(right, u), Math.min(top, v), Math.max(bottom, v)];
  });
  return left > right ? null : { left, right, top, bottom };
}

/** A region with what is around it, as large as it fits; nothing beside the image is shown that needn't be. */
export function around({ left, right, top, bottom }: Region, [columns, rows]: Size, [width, height]: Size): Frame {
  const least = LEAST_AROUND * columns;
  const [wide, high] = [Math.max(AROUND * (right - left), least), Math.max(AROUND * (bottom - top), least)];
  const scale = Math.max(Math.min(width / wide, height / high), Math.min(width / columns, height / rows));
  const middle = (at: number, shown: number, all: number): number =>
    shown >= all ? all / 2 : Math.min(Math.max(at, shown / 2), all - shown / 2);
  const x = middle((left + right + 1) / 2, width / scale, columns);
  const y = middle((top + bottom + 1) / 2, height / scale, rows);
  return { scale, left: width / 2 - x * scale, top: height / 2 - y * scale };
}

export function movedBy(frame: Frame, right: number, down: number): Frame {
  return { ...frame, left: frame.left + right, top: frame.top + down };
}

/** u, v, u, v, ... to CSS pixels; NaN stays NaN. */
export function toScreen({ scale, left, top }: Frame, places: Float32Array): Float32Array {
  return places.map((value, i) => (value + 0.5) * scale + (i % 2 === 0 ? left : top));
}
