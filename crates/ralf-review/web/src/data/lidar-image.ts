/** The points of a LiDAR scan that lie in an image. */

import { floats, type Table } from "../api/table.js";

export interface LidarInImage {
  readonly count: number;
  /** Column and row in the image, px; the farthest point comes first. */
  readonly u: Float32Array;
  readonly v: Float32Array;
  /** Along the camera's axis, m. */
  readonly depth: Float32Array;
  /** Above the vehicle's origin, m. */
  readonly z: Float32Array;
}

export function lidarInImage(table: Table<object>): LidarInImage {
  const [u, v, depth, z] = ["u", "v", "depth", "z"].map((name) => floats(table, name));
  return { count: table.rows, u, v, depth, z };
}
