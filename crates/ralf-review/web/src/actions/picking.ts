/** Choosing single detections by keyboard: from left to right around the vehicle, one after the other. */

import { columnOf, pointOf } from "../data/cloud.js";
import { degrees } from "../format.js";
import { NOTHING_LOOKED_AT } from "../state.js";
import type { World } from "./world.js";

export class Picking {
  constructor(private readonly world: World) {}

  /** Selects the next detection that may be changed (or the one before), and says what it is. */
  step(by: 1 | -1): void {
    const { store } = this.world;
    const { cloud, eligible, selection } = store.state;
    const order = inTurn(cloud.positions, eligible);
    if (order.length === 0) return store.set({ announced: "No detection to choose." });
    const at = order.findIndex((index) => selection[index] === 1);
    const next = at < 0 ? (by === 1 ? 0 : order.length - 1) : (at + by + order.length) % order.length;
    const index = order[next];
    const chosen = new Uint8Array(selection.length);
    chosen[index] = 1;
    const announced = this.describe(index, next, order.length);
    // Whoever chooses another one isn't answering what was asked any more.
    store.set({ ...NOTHING_LOOKED_AT, selection: chosen, picked: index, announced });
  }

  private describe(index: number, place: number, count: number): string {
    const { cloud, labels } = this.world.store.state;
    const { scan } = pointOf(cloud, index);
    const [x, y] = [cloud.positions[3 * index], cloud.positions[3 * index + 1]];
    const where = `${Math.hypot(x, y).toFixed(1)} m at ${degrees(Math.atan2(y, x))}`;
    const w = columnOf(cloud, index, "w");
    const by = cloud.corrected[index] === 1 ? "corrected" : "by machine";
    const label = labels.name(cloud.label[index]);
    return `Detection ${place + 1} of ${count}, ${scan.radar}: ${label} ${by}, ${where}, w ${w.toFixed(2)}`;
  }
}

/** From left to right, which is from the largest angle to the smallest; what has no place is left out. */
function inTurn(positions: Float32Array, eligible: Uint8Array): readonly number[] {
  const angle = (i: number): number => Math.atan2(positions[3 * i + 1], positions[3 * i]);
  const found = [...eligible.keys()].filter((i) => eligible[i] === 1 && !Number.isNaN(positions[3 * i]));
  return found.sort((a, b) => angle(b) - angle(a) || a - b);
}
