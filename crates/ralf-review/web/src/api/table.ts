/** Tables as the server sends them: a JSON header, then little-endian columns, each at a multiple of 8. */

export type Column = Float32Array | Uint8Array | Uint16Array | Int32Array | Uint32Array;

/** What kind of number a column holds, where the server says so. */
export type ColumnGroup = "place" | "measured" | "mismatch" | "plausibility";

export interface ColumnInfo {
  readonly name: string;
  readonly type: ColumnType;
  readonly offset: number;
  readonly unit?: string;
  readonly meaning?: string;
  readonly group?: ColumnGroup;
}

export interface Table<Header> {
  readonly rows: number;
  /** Every column, as the server tells of it. */
  readonly infos: readonly ColumnInfo[];
  readonly header: Header;
  readonly columns: ReadonlyMap<string, Column>;
}

type ColumnType = "f32" | "u8" | "u16" | "i32" | "u32";

interface TableHeader {
  readonly rows: number;
  readonly columns: readonly ColumnInfo[];
}

const ARRAYS = {
  f32: Float32Array,
  u8: Uint8Array,
  u16: Uint16Array,
  i32: Int32Array,
  u32: Uint32Array,
} as const;

/** Reads a table; the columns are views into `buffer`. Throws an `Error` that says what doesn't fit. */
export function decodeTable<Header>(buffer: ArrayBuffer): Table<Header> {
  if (buffer.byteLength < 4) throw new Error(`table: expected a header, found ${buffer.byteLength} bytes`);
  const length = new DataView(buffer).getUint32(0, true);
  const body = 4 + length;
  if (body > buffer.byteLength || body % 8 !== 0) {
    throw new Error(`table: a header of ${length} bytes doesn't fit ${buffer.byteLength} bytes in steps of 8`);
  }
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))) as TableHeader & Header;
  const columns = new Map<string, Column>();
  for (const { name, type, offset } of header.columns) {
    const Type = ARRAYS[type];
    const start = body + offset;
    if (Type === undefined) throw new Error(`table: column ${name} has the unknown type ${String(type)}`);
    if (offset % 8 !== 0 || start + header.rows * Type.BYTES_PER_ELEMENT > buffer.byteLength) {
      throw new Error(`table: column ${name} at ${offset} with ${header.rows} rows exceeds ${buffer.byteLength} bytes`);
    }
    columns.set(name, new Type(buffer, start, header.rows));
  }
  return { rows: header.rows, infos: header.columns, header, columns };
}

/** A column of floats; throws where the table has none of that name and type. */
export function floats<Header>(table: Table<Header>, name: string): Float32Array {
  const column = table.columns.get(name);
  if (column instanceof Float32Array) return column;
  throw new Error(`table: expected the f32 column ${name}`);
}
