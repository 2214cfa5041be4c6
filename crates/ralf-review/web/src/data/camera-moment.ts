/** A camera at the moment of the scan under review: its image, and where the detections lie in it. */

import type { Table } from "../api/table.js";
import { floats } from "../api/table.js";
import type { CameraInfo } from "../api/types.js";
import type { Cloud } from "./cloud.js";

export interface CameraMoment {
  readonly info: CameraInfo;
  readonly image: number;
  /** The monitor found that it shows nothing useful. */
  readonly failed: boolean;
  /** `null` until it has come. */
  readonly picture: ImageBitmap | null;
  /** Why there is no picture. */
  readonly problem: string | null;
  /** u, v of each detection on screen, px; NaN where it isn't in the image. */
  readonly places: Float32Array;
}

export function withoutPlaces(count: number): Float32Array {
  return new Float32Array(2 * count).fill(Number.NaN);
}

/** Sets the places of one scan's detections. */
export function placeScan(places: Float32Array, cloud: Cloud, scan: number, table: Table<object>): void {
  const [u, v] = [floats(table, "u"), floats(table, "v")];
  const first = 2 * cloud.starts[scan];
  for (let i = 0; i < table.rows; i++) {
    places[first + 2 * i] = u[i];
    places[first + 2 * i + 1] = v[i];
  }
}

/** The camera in which most of the first scan's detections lie. */
export function busiest(cameras: readonly CameraMoment[], cloud: Cloud): string | null {
  const rows = cloud.scans[0]?.table.rows ?? 0;
  const seen = ({ places }: CameraMoment): number =>
    places.subarray(0, 2 * rows).reduce((sum, value) => sum + Number(!Number.isNaN(value)), 0);
  const most = cameras.reduce<CameraMoment | null>(
    (best, one) => (best === null || seen(one) > seen(best) ? one : best),
    null,
  );
  return most?.info.name ?? null;
}
