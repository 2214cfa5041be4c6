/** Puts a scan on screen: its detections and LiDAR first, the cameras as they come. */

import type { ScanId } from "../api/types.js";
import { type CameraMoment, withoutPlaces } from "../data/camera-moment.js";
import type { Cloud } from "../data/cloud.js";
import type { Lidar } from "../data/lidar.js";
import { sameScan, type Scan } from "../data/scan.js";
import { MOST_ACCUMULATED } from "../state.js";
import { Imagery } from "./imagery.js";
import { complain, type World } from "./world.js";

export class Moment {
  private generation = 0;
  private pictures: Promise<void> = Promise.resolve();
  private readonly imagery: Imagery;

  constructor(private readonly world: World) {
    this.imagery = new Imagery(world);
    world.store.watch(
      ({ lidarShown }) => [lidarShown],
      () => void this.readLidar().catch((error: unknown) => complain(world, error)),
    );
  }

  /** Resolves once the scan is on screen, or another one was asked for. */
  async show(id: ScanId): Promise<void> {
    const { store, loader } = this.world;
    const generation = ++this.generation;
    const { sequence, accumulate } = store.state;
    store.set({ current: id, loading: true, hover: -1 });
    try {
      const [around, lidar] = await Promise.all([
        loader.around(sequence, id, accumulate),
        loader.scan(sequence, id).then((scan) => this.lidarOrNone(scan)),
      ]);
      // Last: a stroke on these scans may have been saved while the rest was read.
      const cloud = await loader.cloud(sequence, around);
      if (generation !== this.generation) return;
      const before = store.state.cameras;
      const cameras = this.camerasOf(cloud).map((camera) => withKnownPicture(camera, before));
      store.set({ cloud, lidar, cameras, selection: new Uint8Array(cloud.count), loading: false });
      // They are not waited for here: what is looked at is selected before anything else can be chosen.
      this.pictures = Promise.all(cameras.map((camera) => this.imagery.complete(cloud, camera))).then(
        () => undefined,
        (error: unknown) => complain(this.world, error),
      );
    } catch (error) {
      if (generation !== this.generation) return;
      const { scans } = store.state.cloud;
      store.set({ loading: false, current: scans[0] ?? null });
      complain(this.world, error);
    }
  }

  /** Resolves once the cameras' pictures of what is on screen are there, or can't be read. */
  pictured(): Promise<void> {
    return this.pictures;
  }

  /** Reads what will probably be looked at next. */
  async prefetch(id: ScanId): Promise<void> {
    const { loader, store } = this.world;
    const { sequence, accumulate } = store.state;
    const scan = await loader.scan(sequence, id);
    await Promise.all([loader.around(sequence, id, accumulate), this.lidarOf(scan)]);
  }

  /** What is drawn of the LiDAR: nothing is read of what isn't shown. */
  private async lidarOf(scan: Scan): Promise<Lidar | null> {
    const { lidarShown, accumulate, sequence } = this.world.store.state;
    return lidarShown ? this.world.loader.lidar(sequence, scan, accumulate === MOST_ACCUMULATED) : null;
  }

  /** Detections are shown without a LiDAR scan that can't be read. */
  private async lidarOrNone(scan: Scan): Promise<Lidar | null> {
    return this.lidarOf(scan).catch((error: unknown) => {
      complain(this.world, error);
      return null;
    });
  }

  /** Reads the LiDAR of the scan on screen, where it wasn't shown. */
  private async readLidar(): Promise<void> {
    const { store } = this.world;
    const [scan] = store.state.cloud.scans;
    if (scan === undefined || store.state.lidar !== null) return;
    const { generation } = this;
    const lidar = await this.lidarOf(scan);
    if (generation === this.generation) store.set({ lidar });
  }

  private camerasOf(cloud: Cloud): readonly CameraMoment[] {
    const { recording, sequence } = this.world.store.state;
    const { cameras: near, failed_cameras: failed } = cloud.scans[0].table.header;
    const infos = recording.sequences.find(({ name }) => name === sequence)?.cameras ?? [];
    return infos.flatMap((info) => {
      const at = near.find(({ name }) => name === info.name);
      if (at === undefined) return [];
      const places = withoutPlaces(cloud.count);
      const failing = failed.includes(info.name);
      return [{ info, image: at.image, failed: failing, picture: null, problem: null, places, lidar: null }];
    });
  }

  /** Whether the scan is among those on screen. */
  shows(id: ScanId): boolean {
    return this.world.store.state.cloud.scans.some((scan) => sameScan(scan, id));
  }
}

/** The picture that is on screen already stays there while its projections are read anew. */
function withKnownPicture(camera: CameraMoment, before: readonly CameraMoment[]): CameraMoment {
  const known = before.find(({ info, image }) => info === camera.info && image === camera.image);
  return { ...camera, picture: known?.picture ?? null };
}
