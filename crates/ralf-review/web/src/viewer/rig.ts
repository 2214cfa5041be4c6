/**
 * Where one looks from. Bird's eye and free view share the place looked at and how much of it is seen, so that
 * switching between them keeps one's bearings. Vehicle frame: x forward (up on screen), y left, z up.
 */

export interface Rig {
  /** The place looked at, m. */
  readonly target: readonly [x: number, y: number, z: number];
  /** How many metres the view is high at the target. */
  readonly span: number;
  /** Free view: direction looked in, rad, 0 forward, positive to the left. */
  readonly yaw: number;
  /** Free view: how steeply one looks down, rad. */
  readonly pitch: number;
}

export const FIELD_OF_VIEW = (45 * Math.PI) / 180;
const LEAST_SPAN = 4;
const MOST_SPAN = 2000;
const LEAST_PITCH = 0.02;
const MOST_PITCH = Math.PI / 2 - 0.01;

export const HOME: Rig = { target: [0, 0, 0], span: 100, yaw: 0, pitch: 0.55 };

/**
 * Home, or as much farther away as it takes to have all places (x, y, z, x, y, z, ..., m) in a picture of this size.
 */
export function around(positions: Float32Array, [width, height]: readonly [number, number]): Rig {
  let [forward, left] = [0, 0];
  for (let i = 0; i < positions.length; i += 3) {
    if (Number.isNaN(positions[i])) continue;
    forward = Math.max(forward, Math.abs(positions[i]));
    left = Math.max(left, Math.abs(positions[i + 1]));
  }
  const span = 2.1 * Math.max(forward, (left * height) / width);
  return { ...HOME, span: clamp(span, HOME.span, MOST_SPAN) };
}

export function zoomed(rig: Rig, factor: number, anchor: readonly [number, number] | null): Rig {
  const span = clamp(rig.span * factor, LEAST_SPAN, MOST_SPAN);
  const ratio = span / rig.span;
  if (anchor === null) return { ...rig, span };
  const [x, y, z] = rig.target;
  return { ...rig, span, target: [anchor[0] + (x - anchor[0]) * ratio, anchor[1] + (y - anchor[1]) * ratio, z] };
}

/** Moves the view by pixels to the right and down, so that the ground follows the pointer. */
export function panned(rig: Rig, right: number, down: number, height: number, bird: boolean): Rig {
  const metres = rig.span / height;
  const yaw = bird ? 0 : rig.yaw;
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const forward = (down * metres) / (bird ? 1 : Math.max(Math.sin(rig.pitch), 0.3));
  const left = right * metres;
  const [x, y, z] = rig.target;
  return { ...rig, target: [x + forward * cos - left * sin, y + forward * sin + left * cos, z] };
}

export function turned(rig: Rig, right: number, down: number): Rig {
  const step = 0.006;
  return { ...rig, yaw: rig.yaw - right * step, pitch: clamp(rig.pitch + down * step, LEAST_PITCH, MOST_PITCH) };
}

/** How far the eye of the free view is from the target, m. */
export function eyeDistance({ span }: Rig): number {
  return span / 2 / Math.tan(FIELD_OF_VIEW / 2);
}

/** The eye of the free view, m. */
export function eye(rig: Rig): readonly [number, number, number] {
  const distance = eyeDistance(rig);
  const flat = distance * Math.cos(rig.pitch);
  const [x, y, z] = rig.target;
  return [x - flat * Math.cos(rig.yaw), y - flat * Math.sin(rig.yaw), z + distance * Math.sin(rig.pitch)];
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(Math.max(value, least), most);
}
