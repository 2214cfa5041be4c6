/** A LiDAR's points over an image. They are set pixel by pixel: 180,000 of them take some milliseconds. */

import type { LidarInImage } from "../data/lidar-image.js";
import { viridis } from "../viewer/palette.js";
import type { Frame } from "./frame.js";

export type LidarColour = "depth" | "height";

/** Depths from here to there have the map's ends, m. */
const DEPTHS = [2, 80] as const;
/** Heights likewise, as in the scene, m. */
const HEIGHTS = [-1, 5] as const;
const STEPS = 256;
/** An image this many pixels wide on screen has points of one pixel. */
const IMAGE_PER_POINT = 480;
const LARGEST = 6;

/** The map's colours as a canvas keeps them: red, green, blue, opaque, in the order of bytes. */
const COLOURS = Uint32Array.from({ length: STEPS }, (_, step) => {
  const [red, green, blue] = viridis(step / (STEPS - 1));
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
});

/** What is near is bright: depths go by their logarithm. */
export function shareOf(lidar: LidarInImage, i: number, by: LidarColour): number {
  const share =
    by === "depth"
      ? 1 - Math.log(lidar.depth[i] / DEPTHS[0]) / Math.log(DEPTHS[1] / DEPTHS[0])
      : (lidar.z[i] - HEIGHTS[0]) / (HEIGHTS[1] - HEIGHTS[0]);
  return Math.min(Math.max(share, 0), 1);
}

/** At most so much of an image is covered by points; of more only each so manieth is drawn. */
const COVERED = 0.4;

/** Sets the points' pixels (squares of `size`) in a picture of this width; `frame` is in its pixels. */
export function setPoints(
  pixels: Uint32Array,
  width: number,
  lidar: LidarInImage,
  { scale, left, top }: Frame,
  size: number,
  by: LidarColour,
  step = 1,
): void {
  const height = pixels.length / width;
  for (let i = 0; i < lidar.count; i += step) {
    const x = Math.round((lidar.u[i] + 0.5) * scale + left - size / 2);
    const y = Math.round((lidar.v[i] + 0.5) * scale + top - size / 2);
    if (x + size <= 0 || y + size <= 0 || x >= width || y >= height) continue;
    const colour = COLOURS[Math.round(shareOf(lidar, i, by) * (STEPS - 1))];
    const first = Math.max(x, 0);
    const last = Math.min(x + size, width);
    const end = Math.min(y + size, height);
    for (let row = Math.max(y, 0); row < end; row++)
      for (let at = row * width + first; at < row * width + last; at++) pixels[at] = colour;
  }
}

/** The points as they were painted last; painted anew only where something is another. */
export class LidarLayer {
  private readonly canvas = document.createElement("canvas");
  private painted: readonly unknown[] = [];

  /** Draws them over an image of this size, into a context in CSS pixels. */
  drawOn(
    context: CanvasRenderingContext2D,
    lidar: LidarInImage,
    image: readonly [columns: number, rows: number],
    frame: Frame,
    [width, height]: readonly [number, number],
    by: LidarColour,
  ): void {
    const ratio = context.canvas.width / width;
    const wanted = [lidar, frame.scale, frame.left, frame.top, width, height, ratio, by];
    if (wanted.some((value, i) => value !== this.painted[i])) {
      [this.canvas.width, this.canvas.height] = [context.canvas.width, context.canvas.height];
      this.paint(lidar, image, { scale: frame.scale * ratio, left: frame.left * ratio, top: frame.top * ratio }, by);
      this.painted = wanted;
    }
    context.drawImage(this.canvas, 0, 0, width, height);
  }

  private paint(lidar: LidarInImage, [columns, rows]: readonly [number, number], frame: Frame, by: LidarColour): void {
    const { width, height } = this.canvas;
    const context = this.canvas.getContext("2d");
    if (context === null) return;
    const image = context.createImageData(width, height);
    const size = Math.min(Math.max(Math.round((frame.scale * columns) / IMAGE_PER_POINT), 1), LARGEST);
    const room = COVERED * columns * rows * frame.scale ** 2;
    const step = Math.max(Math.ceil((lidar.count * size ** 2) / room), 1);
    setPoints(new Uint32Array(image.data.buffer), width, lidar, frame, size, by, step);
    context.putImageData(image, 0, 0);
  }
}
