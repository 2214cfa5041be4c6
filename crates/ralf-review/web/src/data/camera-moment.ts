/** A camera at the moment of the scan under review: its image, and where the detections lie in it. */

import type { Table } from "../api/table.js";
import { floats } from "../api/table.js";
import type { CameraInfo, ThingInImageHeader } from "../api/types.js";
import { type Cloud, findScan } from "./cloud.js";
import type { LidarInImage } from "./lidar-image.js";

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
  /** `null` where it isn't shown, or has not come. */
  readonly lidar: LidarInImage | null;
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

/** The places with those of a thing, from whatever scans on screen. */
export function placeThing(places: Float32Array, cloud: Cloud, table: Table<ThingInImageHeader>): Float32Array {
  const [u, v] = [floats(table, "u"), floats(table, "v")];
  const [scan, point] = ["scan", "point"].map((name) => table.columns.get(name) ?? new Uint32Array(0));
  const starts = table.header.scans.map((id) => cloud.starts[findScan(cloud, id)] ?? -1);
  const placed = places.slice();
  for (let i = 0; i < table.rows; i++) {
    const start = starts[scan[i]];
    if (start >= 0) placed.set([u[i], v[i]], 2 * (start + point[i]));
  }
  return placed;
}

/** How many of the chosen detections lie in the image. */
export function countIn({ places }: CameraMoment, chosen: Uint8Array): number {
  return chosen.reduce((sum, is, i) => sum + (is === 1 && !Number.isNaN(places[2 * i]) ? 1 : 0), 0);
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
