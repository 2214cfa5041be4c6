/** Rigid motions as row-major 4 by 4 matrices, in metres. */

export type Matrix = readonly number[];

export type Vector = readonly [x: number, y: number, z: number];

export const IDENTITY: Matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** `a_from_b` and `b_from_c` give `a_from_c`. */
export function compose(first: Matrix, second: Matrix): Matrix {
  const product = new Array<number>(16).fill(0);
  for (let row = 0; row < 4; row++) {
    for (let column = 0; column < 4; column++) {
      for (let k = 0; k < 4; k++) product[4 * row + column] += first[4 * row + k] * second[4 * k + column];
    }
  }
  return product;
}

/** The inverse of a rigid motion. */
export function inverse(m: Matrix): Matrix {
  const back = (row: number): number => -(m[row] * m[3] + m[4 + row] * m[7] + m[8 + row] * m[11]);
  return [m[0], m[4], m[8], back(0), m[1], m[5], m[9], back(1), m[2], m[6], m[10], back(2), 0, 0, 0, 1];
}

/** What moves points of the vehicle at one time to the vehicle at another; stays put where one isn't known. */
export function targetFromSource(odomFromTarget: Matrix | null, odomFromSource: Matrix | null): Matrix {
  if (odomFromTarget === null || odomFromSource === null) return IDENTITY;
  return compose(inverse(odomFromTarget), odomFromSource);
}

/** A place of the odometry frame in that of the vehicle; stays put where the vehicle's isn't known. */
export function movePlace(odomFromVehicle: Matrix | null, at: Vector): Vector {
  return place(targetFromSource(odomFromVehicle, odomFromVehicle === null ? null : IDENTITY), at);
}

/** A place moved. */
export function place(m: Matrix, [x, y, z]: Vector): Vector {
  const row = (i: number): number => m[i] * x + m[i + 1] * y + m[i + 2] * z + m[i + 3];
  return [row(0), row(4), row(8)];
}

/** Moves columns of coordinates into `out`, three numbers a point, from point `first` on. */
export function movePoints(
  m: Matrix,
  [x, y, z]: readonly [Float32Array, Float32Array, Float32Array],
  out: Float32Array,
  first: number,
): void {
  for (let i = 0, o = 3 * first; i < x.length; i++, o += 3) {
    out[o] = m[0] * x[i] + m[1] * y[i] + m[2] * z[i] + m[3];
    out[o + 1] = m[4] * x[i] + m[5] * y[i] + m[6] * z[i] + m[7];
    out[o + 2] = m[8] * x[i] + m[9] * y[i] + m[10] * z[i] + m[11];
  }
}
