/** Holding still what moves: its detections, and the LiDAR's points around it, where they are on it. */

import type { LidarHeader } from "../api/types.js";
import type { Table } from "../api/table.js";
import { anchorTime, heldLidar, heldStill, letGo, Path } from "../data/held.js";
import { place, IDENTITY, type Vector } from "../data/transform.js";
import { complain, tell, type World } from "./world.js";

/** So many LiDAR scans along its way are read. */
const MOST_SCANS = 24;

export class Holding {
  /** What is held, as it was chosen; `null` where nothing is. */
  private chosen: Uint8Array | null = null;

  constructor(private readonly world: World) {
    const { store } = world;
    store.watch(
      ({ cloud, lidarShown }) => [cloud.held, lidarShown, cloud.measured],
      (held, shown) => {
        if (!held) this.chosen = null;
        if (!held && store.state.heldLidar !== null) store.set({ heldLidar: null });
        if (held && shown && store.state.heldLidar === null)
          this.readLidar().catch((error: unknown) => complain(world, error));
      },
    );
  }

  /** Holds what is selected still over the scans on screen, or lets it go. */
  toggle(): void {
    const { store } = this.world;
    const { cloud, selection } = store.state;
    const next = cloud.held ? letGo(cloud) : heldStill(cloud, selection);
    if (next === cloud) return tell(this.world, "Select what moves first: it is held still over the scans on screen.");
    if (next.held) this.chosen = selection;
    store.set({ cloud: next });
    tell(
      this.world,
      next.held ? "Held still: the scans are moved. Shift+H lets it go." : "As the vehicle measured it.",
    );
  }

  private async readLidar(): Promise<void> {
    const { store, loader } = this.world;
    const { cloud, sequence } = store.state;
    const { chosen } = this;
    const lidar = cloud.scans[0]?.table.header.lidar ?? null;
    const path = chosen === null ? null : Path.of(cloud, chosen);
    if (chosen === null || path === null || lidar === null) return;
    const odomFromTarget = cloud.scans[0].table.header.odom_from_vehicle;
    const read = this.scansAlong(path, lidar.name).map(({ scan, t_ns }) => {
      const [x, y] = place(odomFromTarget ?? IDENTITY, path.at(t_ns));
      return loader.lidarNear(sequence, { name: lidar.name, scan }, { x, y, radius: path.reach });
    });
    const tables = await readable(read);
    if (store.state.cloud.measured !== cloud.measured || chosen !== this.chosen) return;
    const anchor: Vector = path.at(anchorTime(cloud, chosen));
    store.set({ heldLidar: heldLidar(tables, path, anchor, odomFromTarget, lidar) });
  }

  /** The scans of a LiDAR while what is held was seen, as far apart as may be where these are many. */
  private scansAlong(path: Path, name: string): readonly { readonly scan: number; readonly t_ns: string }[] {
    const { recording, sequence } = this.world.store.state;
    const known = recording.sequences.find((one) => one.name === sequence)?.lidars.find((one) => one.name === name);
    const [first, last] = path.times;
    const along = (known?.scans ?? [])
      .map((t_ns, scan) => ({ scan, t_ns }))
      .filter(({ t_ns }) => BigInt(t_ns) >= first && BigInt(t_ns) <= last);
    const step = Math.max(Math.ceil(along.length / MOST_SCANS), 1);
    return along.filter((_, i) => i % step === 0);
  }
}

/** Those that can be read; fails where none can. */
async function readable(coming: readonly Promise<Table<LidarHeader>>[]): Promise<readonly Table<LidarHeader>[]> {
  const read = await Promise.allSettled(coming);
  const [failed] = read.filter((one) => one.status === "rejected");
  const tables = read.flatMap((one) => (one.status === "fulfilled" ? [one.value] : []));
  if (tables.length === 0 && failed !== undefined) throw failed.reason;
  return tables;
}
