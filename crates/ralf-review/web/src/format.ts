/** Numbers and times as people read them. */

const ABSENT = "–";

export function decimal(value: number, digits: number): string {
  return Number.isFinite(value) ? value.toFixed(digits) : ABSENT;
}

export function degrees(radians: number): string {
  return `${decimal((radians * 180) / Math.PI, 1)}°`;
}

/** Seconds from the first to the second time, both in nanoseconds. */
export function secondsBetween(first: string, second: string): number {
  return Number(BigInt(second) - BigInt(first)) * 1e-9;
}

/** An ISO 8601 time in the reader's own zone and manner. */
export function clock(at: string): string {
  const time = new Date(at);
  return Number.isNaN(time.getTime())
    ? at
    : time.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" });
}

export function counted(count: number, one: string, many = `${one}s`): string {
  return `${count.toLocaleString("en")} ${count === 1 ? one : many}`;
}

/** `radar_front` is just "front" among radars. */
export function shortName(radar: string): string {
  return radar.replace(/^radar[_-]?/i, "") || radar;
}
