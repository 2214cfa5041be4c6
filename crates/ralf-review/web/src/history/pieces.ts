/** A stroke that is too large for one request is made in several, which are one step. */

import { randomName } from "../api/session.js";
import type { ScanPoints } from "../api/types.js";
import { baseOf } from "../data/opinion.js";
import type { Pending } from "./outbox.js";

/** So many bytes of scans, half of what a server takes at once. */
const ROOM = 4_000_000;
/** A scan's own bytes at most, besides its radar's name: twice its number, its revision and its content. */
const OF_SCAN = 250;
/** Of its radar's name, which is there twice, a character. */
const OF_CHARACTER = 12;
/** Of a detection's number. */
const OF_POINT = 8;

/** The stroke itself, or several of one group, each on other scans. */
export function inPieces(pending: Pending, room = ROOM): readonly Pending[] {
  const { stroke } = pending;
  const [first, ...others] = piecesOf(stroke.points, room);
  if (first === undefined || others.length === 0) return [pending];
  const group = stroke.group ?? randomName();
  const piece = (points: readonly ScanPoints[], id: string): Pending => ({
    ...pending,
    stroke: { ...stroke, id, group, points, base: baseOf(stroke, points) },
  });
  return [piece(first, stroke.id), ...others.map((points) => piece(points, randomName()))];
}

function piecesOf(points: readonly ScanPoints[], room: number): ScanPoints[][] {
  const pieces: ScanPoints[][] = [];
  let left = 0;
  for (const part of points) {
    const size = OF_SCAN + OF_CHARACTER * part.radar.length + OF_POINT * part.points.length;
    const last = pieces.at(-1);
    if (last === undefined || size > left) {
      pieces.push([part]);
      left = room - size;
    } else {
      last.push(part);
      left -= size;
    }
  }
  return pieces;
}
