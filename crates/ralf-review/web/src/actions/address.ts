/** The page's address names the scan, so that a reload comes back to it: #sequence/radar/scan. */

import type { ScanId } from "../api/types.js";

export interface Address {
  readonly sequence: string;
  readonly scan: ScanId | null;
}

export function addressText({ sequence, scan }: Address): string {
  const parts = scan === null ? [sequence] : [sequence, scan.radar, String(scan.scan)];
  return `#${parts.map(encodeURIComponent).join("/")}`;
}

export function addressFrom(hash: string): Address | null {
  const [sequence, radar, scan] = hash.replace(/^#/, "").split("/").map(decoded);
  if (sequence === undefined || sequence === "") return null;
  const known = radar !== undefined && scan !== undefined && /^\d+$/.test(scan);
  return { sequence, scan: known ? { radar, scan: Number(scan) } : null };
}

/** What isn't encoded as it should be, such as a single `%`, is taken as it is. */
function decoded(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}
