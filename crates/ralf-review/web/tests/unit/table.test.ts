import assert from "node:assert/strict";
import { test } from "node:test";
import { decodeTable, floats } from "../../src/api/table.js";

interface Part {
  readonly name: string;
  readonly type: string;
  readonly bytes: Uint8Array;
}

/** A table put together byte by byte, as docs/review-api.md says. */
function encoded(rows: number, parts: readonly Part[], extra: object = {}): ArrayBuffer {
  let offset = 0;
  const columns = parts.map(({ name, type, bytes }) => {
    const column = { name, type, offset };
    offset += Math.ceil(bytes.length / 8) * 8;
    return column;
  });
  let header = JSON.stringify({ rows, columns, ...extra });
  while ((4 + header.length) % 8 !== 0) header += " ";
  const whole = new Uint8Array(4 + header.length + offset);
  new DataView(whole.buffer).setUint32(0, header.length, true);
  whole.set(new TextEncoder().encode(header), 4);
  parts.forEach(({ bytes }, i) => whole.set(bytes, 4 + header.length + columns[i].offset));
  return whole.buffer;
}

const bytes = (array: Float32Array | Uint16Array): Uint8Array => new Uint8Array(array.buffer);

test("columns of every width come out as they went in", () => {
  const table = decodeTable<{ revision: number }>(
    encoded(
      3,
      [
        { name: "w", type: "f32", bytes: bytes(new Float32Array([0.5, Number.NaN, -1])) },
        { name: "corrected", type: "u8", bytes: new Uint8Array([1, 0, 1]) },
        { name: "label", type: "u16", bytes: bytes(new Uint16Array([1, 99, 252])) },
      ],
      { revision: 7 },
    ),
  );
  assert.equal(table.rows, 3);
  assert.equal(table.header.revision, 7);
  assert.deepEqual([...floats(table, "w")], [0.5, Number.NaN, -1]);
  assert.deepEqual([...(table.columns.get("corrected") ?? [])], [1, 0, 1]);
  assert.deepEqual([...(table.columns.get("label") ?? [])], [1, 99, 252]);
});

test("a table without rows has its columns", () => {
  const table = decodeTable(encoded(0, [{ name: "x", type: "f32", bytes: new Uint8Array(0) }]));
  assert.equal(floats(table, "x").length, 0);
});

test("what doesn't fit is refused", () => {
  const whole = encoded(2, [{ name: "x", type: "f32", bytes: bytes(new Float32Array([1, 2])) }]);
  assert.throws(() => decodeTable(new ArrayBuffer(3)), /header/);
  assert.throws(() => decodeTable(whole.slice(0, 20)), /doesn't fit/);
  assert.throws(() => decodeTable(whole.slice(0, whole.byteLength - 8)), /column x/);
  assert.throws(() => decodeTable(encoded(1, [{ name: "x", type: "f64", bytes: new Uint8Array(8) }])), /unknown type/);
  assert.throws(() => floats(decodeTable(whole), "y"), /f32 column y/);
});
