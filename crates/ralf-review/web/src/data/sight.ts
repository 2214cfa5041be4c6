/** Which detections of the scan under review were on screen since it was opened. */

import type { Cloud } from "./cloud.js";
import { scanKey } from "./scan.js";

/** Detections that nobody can have looked at. */
export interface Unseen {
  readonly all: number;
  /** Of these, the ones that the filter hides now. */
  readonly hidden: number;
}

export class Sight {
  private seen = new Uint8Array(0);
  private of = "";

  /** A picture was drawn: `places` are x, y of every detection, NaN where it isn't in it. */
  saw(cloud: Cloud, shown: Uint8Array, places: Float32Array): void {
    const rows = this.rows(cloud);
    for (let i = 0; i < rows; i++) if (shown[i] === 1 && !Number.isNaN(places[2 * i])) this.seen[i] = 1;
  }

  unseen(cloud: Cloud, shown: Uint8Array): Unseen {
    const [rows, unseen] = [this.rows(cloud), { all: 0, hidden: 0 }];
    for (let i = 0; i < rows; i++) {
      // What was measured nowhere can't be on any screen; what is away while something is held still can.
      if (this.seen[i] === 1 || Number.isNaN(cloud.measured[3 * i])) continue;
      unseen.all += 1;
      if (shown[i] === 0) unseen.hidden += 1;
    }
    return unseen;
  }

  /** How many detections the scan has; another scan, or other labels of it, begin unseen. */
  private rows({ scans }: Cloud): number {
    const scan = scans[0];
    if (scan === undefined) return 0;
    const key = `${scanKey(scan)} ${scan.table.header.stamp} ${scan.table.header.t_ns}`;
    if (key !== this.of) [this.of, this.seen] = [key, new Uint8Array(scan.table.rows)];
    return scan.table.rows;
  }
}
