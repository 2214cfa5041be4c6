/** Puts a scan on screen: its detections and LiDAR first, the cameras as they come. */

import { messageOf } from "../api/errors.js";
import type { ScanId } from "../api/types.js";
import { type CameraMoment, placeScan, withoutPlaces } from "../data/camera-moment.js";
import type { Cloud } from "../data/cloud.js";
import type { Lidar } from "../data/lidar.js";
import { sameScan, type Scan } from "../data/scan.js";
import { MOST_ACCUMULATED } from "../state.js";
import { complain, type World } from "./world.js";

export class Moment {
  private generation = 0;

  constructor(private readonly world: World) {
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
      const [cloud, lidar] = await Promise.all([
        loader.cloud(sequence, id, accumulate),
        loader.scan(sequence, id).then((scan) => this.lidarOrNone(scan)),
      ]);
      if (generation !== this.generation) return;
      const before = store.state.cameras;
      const cameras = this.camerasOf(cloud).map((camera) => withKnownPicture(camera, before));
      store.set({ cloud, lidar, cameras, selection: new Uint8Array(cloud.count), loading: false });
      await Promise.all(cameras.map((camera) => this.complete(generation, cloud, camera)));
    } catch (error) {
      if (generation !== this.generation) return;
      const { scans } = store.state.cloud;
      store.set({ loading: false, current: scans[0] ?? null });
      complain(this.world, error);
    }
  }

  /** Reads what will probably be looked at next. */
  async prefetch(id: ScanId): Promise<void> {
    const { loader, store } = this.world;
    const { sequence, accumulate } = store.state;
    const scan = await loader.scan(sequence, id);
    await Promise.all([loader.cloud(sequence, id, accumulate), this.lidarOf(scan)]);
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
      return [{ info, image: at.image, failed: failed.includes(info.name), picture: null, problem: null, places }];
    });
  }

  private async complete(generation: number, cloud: Cloud, camera: CameraMoment): Promise<void> {
    const { loader, store } = this.world;
    const { sequence } = store.state;
    const name = camera.info.name;
    const update = (patch: Partial<CameraMoment>): void => {
      if (generation !== this.generation) return;
      store.set({
        cameras: store.state.cameras.map((other) => (other.info.name === name ? { ...other, ...patch } : other)),
      });
    };
    const picture = loader.image(sequence, name, camera.image).then(
      (image) => update({ picture: image, problem: null }),
      (error: unknown) => update({ problem: messageOf(error) }),
    );
    const places = withoutPlaces(cloud.count);
    const near = nearInTime(cloud);
    const read = cloud.scans.map(async (scan, index) => {
      if (!near[index]) return;
      placeScan(places, cloud, index, await loader.projections(sequence, name, camera.image, scan));
      if (index === 0) update({ places: places.slice() });
    });
    await Promise.all([
      picture,
      Promise.all(read).then(
        () => update({ places }),
        (error: unknown) => update({ problem: messageOf(error) }),
      ),
    ]);
  }

  /** Whether the scan is among those on screen. */
  shows(id: ScanId): boolean {
    return this.world.store.state.cloud.scans.some((scan) => sameScan(scan, id));
  }
}

/** How far in time a scan may be from the current one to be shown in an image, ns. */
const NEAR_NS = 150_000_000n;

/** Which scans belong into the images of this moment: not those of a whole sequence. */
function nearInTime({ scans }: Cloud): readonly boolean[] {
  const now = BigInt(scans[0].table.header.t_ns);
  return scans.map(({ table }) => {
    const apart = BigInt(table.header.t_ns) - now;
    return apart <= NEAR_NS && apart >= -NEAR_NS;
  });
}

/** The picture that is on screen already stays there while its projections are read anew. */
function withKnownPicture(camera: CameraMoment, before: readonly CameraMoment[]): CameraMoment {
  const known = before.find(({ info, image }) => info === camera.info && image === camera.image);
  return { ...camera, picture: known?.picture ?? null };
}
