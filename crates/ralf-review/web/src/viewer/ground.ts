/** What gives the picture its scale: rings of equal range, axes, and the vehicle. Vehicle frame, m. */

import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments } from "three";

export const RINGS = [10, 20, 30, 40, 50, 75, 100, 150, 200] as const;
/** A car of the middle class; its origin is the rear axle's centre. As in `ralf plot`. */
const CAR = { rear: -1, front: 3.6, halfWidth: 0.95, height: 1.5 };
const SEGMENTS = 128;

type Place = readonly [number, number, number];

export function ground(): Group {
  const group = new Group();
  group.add(lines(RINGS.flatMap(ring), 0x232b37), lines(axes(), 0x2c3644), lines(car(), 0xc9d2de));
  return group;
}

function lines(places: readonly Place[], colour: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places.flat()), 3));
  const drawn = new LineSegments(geometry, new LineBasicMaterial({ color: colour, depthWrite: false }));
  drawn.renderOrder = 1;
  drawn.frustumCulled = false;
  return drawn;
}

function ring(radius: number): Place[] {
  const place = (step: number): Place => {
    const angle = (2 * Math.PI * step) / SEGMENTS;
    return [radius * Math.cos(angle), radius * Math.sin(angle), 0];
  };
  return Array.from({ length: SEGMENTS }, (_, step) => [place(step), place(step + 1)]).flat();
}

function axes(): Place[] {
  const far = RINGS[RINGS.length - 1];
  return [
    [-far, 0, 0],
    [far, 0, 0],
    [0, -far, 0],
    [0, far, 0],
  ];
}

/** The vehicle as a box of edges, with an arrow on its roof that shows the heading. */
function car(): Place[] {
  const { rear, front, halfWidth: side, height } = CAR;
  const outline: readonly (readonly [number, number])[] = [
    [front, side],
    [front, -side],
    [rear, -side],
    [rear, side],
  ];
  const edges = outline.flatMap(([x, y], i): Place[] => {
    const [nextX, nextY] = outline[(i + 1) % outline.length];
    return [
      [x, y, 0],
      [nextX, nextY, 0],
      [x, y, height],
      [nextX, nextY, height],
      [x, y, 0],
      [x, y, height],
    ];
  });
  const arrow: Place[] = [
    [1, 0.5, height],
    [2.2, 0, height],
    [2.2, 0, height],
    [1, -0.5, height],
  ];
  return [...edges, ...arrow];
}
