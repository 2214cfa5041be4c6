/**
 * Unsaved strokes in the browser's database: a reload, the server's end, or a closed window loses none. A window
 * takes its own strokes up again; those of a window that was closed are taken up by the next one that opens the same
 * corrections.
 */

import type { Pending } from "./outbox.js";

const DATABASE = "ralf-review";
const STROKES = "strokes";
const WINDOW = "ralf-window";
/** A window says so often that it's open, ms; browsers let one that isn't seen do so once a minute. */
const SAID_MS = 10_000;
const SILENT_MS = 150_000;

interface Kept {
  /** The stroke's own name. */
  readonly id: string;
  /** The corrections that it is for. */
  readonly store: string;
  readonly window: string;
  readonly order: number;
  readonly pending: Pending;
}

export interface Keeper {
  /** What earlier lives of the page left unsaved, in its order. */
  readonly found: readonly Pending[];
  /** Keeps these and no others. Rejects where the browser can't. */
  keep(waiting: readonly Pending[]): Promise<void>;
}

export async function openKeeper(store: string, freshName: () => string): Promise<Keeper> {
  const own = ownWindow(freshName);
  const [database, closed] = [await opened(), await closedWindows(store, own)];
  const all = await answered<Kept[]>(database.transaction(STROKES).objectStore(STROKES).getAll());
  const mine = all.filter((kept) => kept.store === store && (kept.window === own || closed(kept.window)));
  mine.sort((a, b) => a.order - b.order);
  const found = mine.map(({ pending }) => pending);
  const written = new Map(mine.map(({ id, order, pending }) => [id, { order, pending }]));
  let last = mine.at(-1)?.order ?? 0;
  const keep = async (waiting: readonly Pending[]): Promise<void> => {
    const transaction = database.transaction(STROKES, "readwrite");
    const strokes = transaction.objectStore(STROKES);
    const now = new Set(waiting.map(({ stroke }) => stroke.id));
    for (const id of [...written.keys()].filter((known) => !now.has(known))) {
      strokes.delete(id);
      written.delete(id);
    }
    for (const pending of waiting) {
      const { id } = pending.stroke;
      const before = written.get(id);
      if (before?.pending === pending) continue;
      const order = before?.order ?? (last += 1);
      const kept: Kept = { id, store, window: own, order, pending };
      strokes.put(kept);
      written.set(id, { order, pending });
    }
    await ended(transaction);
  };
  return { found, keep };
}

/** Where the browser has no database: nothing is kept, and whoever wants to is told why. */
export function keepNothing(reason: unknown): Keeper {
  const keep = (waiting: readonly Pending[]): Promise<void> =>
    waiting.length === 0 ? Promise.resolve() : Promise.reject(reason);
  return { found: [], keep };
}

/** The name of this window, the same over a reload. */
function ownWindow(freshName: () => string): string {
  const known = sessionStorage.getItem(WINDOW) ?? freshName();
  sessionStorage.setItem(WINDOW, known);
  return known;
}

/**
 * Which windows on these corrections are closed, or on others now. Where the browser doesn't say (not on this machine's
 * own address), each window says now and then that it's open: one that was silent for long is taken for closed, and
 * should it not be, its strokes are sent twice and made once.
 */
async function closedWindows(store: string, own: string): Promise<(window: string) => boolean> {
  const lock = (window: string): string => `${WINDOW} ${store} ${window}`;
  if (navigator.locks === undefined) {
    sayOpen(lock(own));
    return (window) => Date.now() - Number(localStorage.getItem(lock(window))) > SILENT_MS;
  }
  // Held as long as the window is open.
  void navigator.locks.request(lock(own), () => new Promise(() => undefined));
  const { held } = await navigator.locks.query();
  const open = new Set(held?.map(({ name }) => name));
  return (window) => !open.has(lock(window));
}

function sayOpen(name: string): void {
  const say = (): void => localStorage.setItem(name, String(Date.now()));
  say();
  setInterval(say, SAID_MS);
  window.addEventListener("pagehide", () => localStorage.removeItem(name));
  window.addEventListener("pageshow", say);
}

function opened(): Promise<IDBDatabase> {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => request.result.createObjectStore(STROKES, { keyPath: "id" });
  return answered(request);
}

function answered<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("the browser's database refused"));
  });
}

function ended(transaction: IDBTransaction): Promise<void> {
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve();
    transaction.onabort = () => reject(transaction.error ?? new Error("the browser's database refused"));
  });
}
