/** How many of the chosen detections lie in each image, counted once for the same places. */

import { type CameraMoment, countIn } from "../data/camera-moment.js";

export class Counting {
  private chosen: Uint8Array | null = null;
  private counts = new WeakMap<Float32Array, number>();

  of(camera: CameraMoment, chosen: Uint8Array): number {
    if (chosen !== this.chosen) [this.chosen, this.counts] = [chosen, new WeakMap()];
    const known = this.counts.get(camera.places);
    if (known !== undefined) return known;
    const count = countIn(camera, chosen);
    this.counts.set(camera.places, count);
    return count;
  }
}
