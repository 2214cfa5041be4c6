/** From metres to pixels, for picking: the same arithmetic as on the graphics card. */

/** A 4 by 4 matrix in columns, as WebGL has it, that takes metres to clip space. */
export type ClipFromWorld = ArrayLike<number>;

/** Pixel x, y (from the upper left) of each place; NaN behind the eye and outside the picture. */
export function projectAll(m: ClipFromWorld, positions: Float32Array, width: number, height: number): Float32Array {
  const pixels = new Float32Array((2 * positions.length) / 3);
  for (let i = 0, o = 0; i < positions.length; i += 3, o += 2) {
    const [x, y, z] = [positions[i], positions[i + 1], positions[i + 2]];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    const right = (m[0] * x + m[4] * y + m[8] * z + m[12]) / w;
    const up = (m[1] * x + m[5] * y + m[9] * z + m[13]) / w;
    const seen = w > 0 && Math.abs(right) <= 1 && Math.abs(up) <= 1;
    pixels[o] = seen ? ((1 + right) / 2) * width : Number.NaN;
    pixels[o + 1] = seen ? ((1 - up) / 2) * height : Number.NaN;
  }
  return pixels;
}
