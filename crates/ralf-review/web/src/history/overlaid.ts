/**
 * Whose edits lie below one's own. The server names who changed a scan last: after a stroke was set on top of another
 * person's edit, that is oneself. Strokes that were made before both are still asked about the other's.
 */

import type { BaseRevision, ConflictBody, ConflictCause, ScanCorrections, ScanId } from "../api/types.js";
import { sameScan, scanKey } from "../data/scan.js";

interface Revision extends ScanId {
  readonly revision: number;
}

export class Overlaid {
  private readonly below = new Map<string, ConflictCause>();

  /** The conflict with the edit that somebody is to decide about. */
  named(sequence: string, body: ConflictBody): ConflictBody {
    const met = body.scans.find((scan) => sameScan(scan, body.conflict));
    if (body.conflict === null || met === undefined) return body;
    const conflict = this.below.get(keyOf(sequence, met)) ?? body.conflict;
    this.below.set(keyOf(sequence, met), conflict);
    return { ...body, conflict };
  }

  /** An own edit came on top of these revisions. */
  cover(sequence: string, base: readonly BaseRevision[], scans: readonly ScanCorrections[]): void {
    for (const one of base) {
      const conflict = this.below.get(keyOf(sequence, one));
      const now = scans.find((scan) => sameScan(scan, one));
      if (conflict !== undefined && now !== undefined) this.below.set(keyOf(sequence, now), conflict);
    }
  }
}

function keyOf(sequence: string, revision: Revision): string {
  return `${sequence}/${scanKey(revision)}/${revision.revision}`;
}
