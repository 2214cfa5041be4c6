/** Fills the cameras of a moment as things come: pictures, detections, the thing that is looked at, LiDAR. */

import { messageOf } from "../api/errors.js";
import { type CameraMoment, placeScan, placeThing, withoutPlaces } from "../data/camera-moment.js";
import type { Cloud } from "../data/cloud.js";
import { lookedAt } from "../state.js";
import { complain, type World } from "./world.js";

export class Imagery {
  constructor(private readonly world: World) {
    const { store } = world;
    store.watch(
      ({ lidarInImages }) => [lidarInImages],
      () => this.each((cloud, camera) => this.addLidar(cloud, camera)),
    );
    store.watch(
      (state) => [lookedAt(state)],
      () => this.each((cloud, camera) => this.addThing(cloud, camera)),
    );
  }

  /** Reads all of a camera at the moment on screen. What comes when another is on screen is left out. */
  async complete(cloud: Cloud, camera: CameraMoment): Promise<void> {
    const { loader, store } = this.world;
    const { sequence } = store.state;
    const name = camera.info.name;
    const failed = (error: unknown): void => this.update(cloud, name, () => ({ problem: messageOf(error) }));
    const picture = loader
      .image(sequence, name, camera.image)
      .then((image) => this.update(cloud, name, () => ({ picture: image, problem: null })), failed);
    const places = withoutPlaces(cloud.count);
    const near = nearInTime(cloud);
    const read = cloud.scans.map(async (scan, index) => {
      if (!near[index]) return;
      placeScan(places, cloud, index, await loader.projections(sequence, name, camera.image, scan));
      if (index === 0) this.update(cloud, name, () => ({ places: places.slice() }));
    });
    const placed = Promise.all(read).then(() => this.update(cloud, name, () => ({ places })), failed);
    const lidar = this.addLidar(cloud, camera).catch(failed);
    await Promise.all([picture, placed.then(() => this.addThing(cloud, camera)).catch(failed), lidar]);
  }

  private each(add: (cloud: Cloud, camera: CameraMoment) => Promise<void>): void {
    const { cloud, cameras } = this.world.store.state;
    const told = (error: unknown): void => complain(this.world, error);
    for (const camera of cameras) add(cloud, camera).catch(told);
  }

  private async addLidar(cloud: Cloud, { info: { name }, image, lidar: known }: CameraMoment): Promise<void> {
    const { loader, store } = this.world;
    const { lidarInImages, sequence } = store.state;
    const scan = cloud.scans[0]?.table.header.lidar ?? null;
    if (!lidarInImages || scan === null || known !== null) return;
    const lidar = await loader.lidarInImage(sequence, name, image, scan);
    this.update(cloud, name, () => ({ lidar }));
  }

  private async addThing(cloud: Cloud, { info: { name }, image }: CameraMoment): Promise<void> {
    const { loader, store } = this.world;
    const thing = lookedAt(store.state)?.thing;
    if (thing === undefined) return;
    const table = await loader.thingInImage(store.state.sequence, name, image, thing);
    if (lookedAt(store.state)?.thing !== thing) return;
    this.update(cloud, name, ({ places }) => ({ places: placeThing(places, cloud, table) }));
  }

  private update(cloud: Cloud, name: string, patch: (camera: CameraMoment) => Partial<CameraMoment>): void {
    const { store } = this.world;
    // Labels may be others meanwhile, and something may be held still; the detections are the same.
    if (store.state.cloud.measured !== cloud.measured) return;
    const changed = (camera: CameraMoment): CameraMoment =>
      camera.info.name === name ? { ...camera, ...patch(camera) } : camera;
    store.set({ cameras: store.state.cameras.map(changed) });
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
