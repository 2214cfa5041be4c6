/** One LiDAR scan on screen. */

import { floats, type Table } from "../api/table.js";
import type { LidarHeader, ScanHeader } from "../api/types.js";
import { targetFromSource, type Matrix } from "./transform.js";

export interface Lidar {
  readonly name: string;
  readonly scan: number;
  readonly count: number;
  /** Columns in the vehicle frame at the LiDAR's time, m. */
  readonly x: Float32Array;
  readonly y: Float32Array;
  readonly z: Float32Array;
  /** 1 where the ground model found ground. */
  readonly ground: Uint8Array;
  /** The vehicle frame at the radar scan's time, from that at the LiDAR's. */
  readonly vehicleFromLidarTime: Matrix;
}

export function lidarFromTable(name: string, scan: number, table: Table<LidarHeader>, radar: ScanHeader): Lidar {
  const ground = table.columns.get("ground");
  return {
    name,
    scan,
    count: table.rows,
    x: floats(table, "x"),
    y: floats(table, "y"),
    z: floats(table, "z"),
    ground: ground instanceof Uint8Array ? ground : new Uint8Array(table.rows),
    vehicleFromLidarTime: targetFromSource(radar.odom_from_vehicle, table.header.odom_from_vehicle),
  };
}
