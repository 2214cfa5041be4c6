/** Reads what a moment needs, and remembers the last of it. */

import type { Api, Near } from "../api/client.js";
import type { Table } from "../api/table.js";
import type { LidarHeader, ScanId, ThingInImageHeader } from "../api/types.js";
import { buildCloud, type Cloud } from "./cloud.js";
import { Cache } from "./cache.js";
import { type Lidar, lidarFromTable } from "./lidar.js";
import { type LidarInImage, lidarInImage } from "./lidar-image.js";
import { sameScan, type Scan, scanFromTable, scanKey } from "./scan.js";

/** Scans that have the same map. */
const MAP_STEP = 50;
/** So many scans are remembered of any recording. */
const LEAST_SCANS = 1200;

export class Loader {
  private readonly scans: Cache<Scan>;
  private readonly lidars = new Cache<Table<LidarHeader>>(6);
  private readonly maps = new Cache<Table<LidarHeader>>(4);
  private readonly near = new Cache<Table<LidarHeader>>(100);
  private readonly images = new Cache<ImageBitmap>(36);
  private readonly places = new Cache<Table<object>>(600);
  private readonly things = new Cache<Table<ThingInImageHeader>>(100);
  private readonly overlays = new Cache<LidarInImage>(16);
  /** Counts what was said of scans since the page was opened. */
  private said = 0;
  /** By sequence: the run whose labels were heard of last. */
  private readonly runs = new Map<string, string>();

  /** `most`: scans that may be on screen at once; there is room for as many that are read ahead. */
  constructor(
    private readonly api: Api,
    most: number,
  ) {
    this.scans = new Cache(Math.max(LEAST_SCANS, 2 * most));
  }

  scan(sequence: string, id: ScanId): Promise<Scan> {
    return this.scans.get(key(sequence, scanKey(id)), async () => {
      const table = await this.api.scan(sequence, id);
      this.heard(sequence, table.header.run);
      return scanFromTable(id, table);
    });
  }

  /** Keeps a scan whose labels are others now, unless somebody labelled again since it was read. */
  keep(sequence: string, scan: Scan): void {
    const { run } = scan.table.header;
    if ((this.runs.get(sequence) ?? run) !== run) return this.forget(sequence, scan);
    this.said += 1;
    this.scans.put(key(sequence, scanKey(scan)), Promise.resolve(scan));
  }

  forget(sequence: string, id: ScanId): void {
    this.said += 1;
    this.scans.forget(key(sequence, scanKey(id)));
  }

  /** Other labels make other things, and other detections have other places in the images. */
  forgetScans(): void {
    this.said += 1;
    for (const kept of [this.scans, this.things, this.places]) kept.clear();
  }

  /** Once somebody labels again, nothing that was read of the labels before is shown beside the new ones. */
  private heard(sequence: string, run: string): void {
    const before = this.runs.get(sequence);
    this.runs.set(sequence, run);
    if (before !== undefined && before !== run) this.forgetScans();
  }

  /** The scan and those around it, of every radar, with so many neighbours; they are read by then. */
  async around(sequence: string, id: ScanId, accumulate: number): Promise<readonly ScanId[]> {
    const first = await this.scan(sequence, id);
    const { run, scans } = await this.api.moment(sequence, first.table.header.t_ns, accumulate);
    this.heard(sequence, run);
    const others = scans.filter((other) => !sameScan(other, id)).map(({ radar, scan }) => ({ radar, scan }));
    await Promise.all(others.map((other) => this.scan(sequence, other)));
    return [id, ...others];
  }

  /** The detections of scans. */
  async cloud(sequence: string, ids: readonly ScanId[]): Promise<Cloud> {
    return buildCloud(await this.newest(sequence, ids));
  }

  /** Scans as they are once all are there: what is said of one while others are read isn't lost. */
  async newest(sequence: string, ids: readonly ScanId[]): Promise<readonly Scan[]> {
    for (;;) {
      const { said } = this;
      const scans = await Promise.all(ids.map((id) => this.scan(sequence, id)));
      if (said === this.said) return scans;
    }
  }

  /** The LiDAR scan of a radar's; `around`: what those around it have seen stand still, where the motion is known. */
  async lidar(sequence: string, { table }: Scan, around: boolean): Promise<Lidar | null> {
    const { lidar } = table.header;
    if (lidar === null) return null;
    const { name, scan } = lidar;
    if (around && table.header.odom_from_vehicle !== null) {
      const middle = scan - (scan % MAP_STEP);
      const map = await this.maps.get(key(sequence, name, middle), () => this.api.lidarMap(sequence, name, middle));
      return lidarFromTable(name, scan, map, table.header);
    }
    const read = await this.lidars.get(key(sequence, name, scan), () => this.api.lidar(sequence, name, scan));
    return lidarFromTable(name, scan, read, table.header);
  }

  /** The points of a LiDAR scan near a place of the odometry frame. */
  lidarNear(
    sequence: string,
    { name, scan }: { readonly name: string; readonly scan: number },
    near: Near,
  ): Promise<Table<LidarHeader>> {
    const read = (): Promise<Table<LidarHeader>> => this.api.lidarNear(sequence, name, scan, near);
    return this.near.get(key(sequence, name, scan, near.x, near.y, near.radius), read);
  }

  image(sequence: string, camera: string, image: number): Promise<ImageBitmap> {
    // Pixels as they lie in the file, as labels have them: no orientation of EXIF turns them.
    const read = async (): Promise<ImageBitmap> =>
      createImageBitmap(await this.api.image(sequence, camera, image), { imageOrientation: "none" });
    return this.images.get(key(sequence, camera, image), read);
  }

  projections(sequence: string, camera: string, image: number, id: ScanId): Promise<Table<object>> {
    const read = (): Promise<Table<object>> => this.api.projections(sequence, camera, image, id);
    return this.places.get(key(sequence, camera, image, scanKey(id)), read);
  }

  thingInImage(sequence: string, camera: string, image: number, thing: number): Promise<Table<ThingInImageHeader>> {
    const read = (): Promise<Table<ThingInImageHeader>> => this.api.thingInImage(sequence, camera, image, thing);
    return this.things.get(key(sequence, camera, image, thing), read);
  }

  lidarInImage(
    sequence: string,
    camera: string,
    image: number,
    lidar: { readonly name: string; readonly scan: number },
  ): Promise<LidarInImage> {
    const read = async (): Promise<LidarInImage> =>
      lidarInImage(await this.api.lidarInImage(sequence, camera, image, lidar));
    return this.overlays.get(key(sequence, camera, image, lidar.name, lidar.scan), read);
  }
}

function key(...parts: readonly (string | number)[]): string {
  return parts.join("|");
}
