/** Hears of what others change, and of the server's coming and going. */

import { isAway, linkAfter } from "../api/errors.js";
import type { Changes } from "../api/types.js";
import { sameScan } from "../data/scan.js";
import type { Adopting } from "./adopting.js";
import type { Correcting } from "./correcting.js";
import type { Queueing } from "./queueing.js";
import type { Relabelling } from "./relabelling.js";
import { complain, tell, type World } from "./world.js";

const PATIENCE_MS = 1500;
const WAKING_MS = 300;

export class Hearing {
  private listening: AbortController | null = null;
  private wake: () => void = () => undefined;

  constructor(
    private readonly world: World,
    private readonly adopting: Adopting,
    private readonly correcting: Correcting,
    private readonly queueing: Queueing,
    private readonly relabelling: Relabelling,
  ) {
    // From the moment a sequence is chosen, while its scans are read: what others change from then on is heard of.
    world.store.watch(
      ({ sequence }) => [sequence],
      (sequence) => (sequence === "" ? undefined : this.listen(sequence)),
    );
    // A stroke got no answer: whether the server is there is asked at once, and not when the long wait ends.
    world.store.watch(
      ({ outbox }) => [outbox.kind],
      (kind) => (kind === "gone" ? this.wake() : undefined),
    );
  }

  /** Listens to a sequence's changes, and to no other's, until told otherwise. */
  private listen(sequence: string): void {
    this.listening?.abort();
    this.listening = new AbortController();
    void this.run(sequence, this.listening.signal);
  }

  private async run(sequence: string, ended: AbortSignal): Promise<void> {
    let since: number | null = null;
    while (!ended.aborted) {
      const poll = pollWhileSeen(ended);
      let [woken, answered] = [false, false];
      this.wake = () => {
        woken = true;
        poll.stop();
      };
      try {
        await seen();
        const changes: Changes = await this.world.api.changes(sequence, since, { signal: poll.signal });
        [since, answered] = [changes.counter, true];
        await this.reconnected(sequence);
        await this.take(sequence, changes);
      } catch (error) {
        if (poll.signal.aborted) continue;
        if (answered && this.world.store.state.link.kind === "fine" && !isAway(error)) {
          complain(this.world, error);
        } else {
          since = null;
          this.world.store.set({ link: linkAfter(error) });
        }
        await pause(PATIENCE_MS);
      } finally {
        poll.end();
        if (woken) {
          since = null;
          await pause(WAKING_MS);
        }
      }
    }
  }

  /** The server is back: what others did meanwhile is read, and what wasn't saved is tried again. */
  private async reconnected(sequence: string): Promise<void> {
    const { store } = this.world;
    if (store.state.link.kind === "fine") return;
    // First of all: while `ralf label` is at work the labels can't be read, and corrections can be written.
    if (store.state.outbox.kind === "gone") await this.correcting.retry();
    if (store.state.outbox.kind === "gone") return;
    await Promise.all([this.relabelling.read(), this.queueing.read(), this.readHistory(sequence)]);
    store.set({ link: { kind: "fine" } });
    await this.adopting.rereadAll();
    // What was refused may be taken by now.
    await this.correcting.retry();
  }

  /** What can be undone; read again where an own edit came between, whose answer may be the newer one. */
  private async readHistory(sequence: string): Promise<void> {
    const { store, api } = this.world;
    for (;;) {
      const before = store.state.history;
      const history = await api.history(sequence);
      if (sequence !== store.state.sequence) return;
      if (before === store.state.history) return store.set({ history });
    }
  }

  private async take(sequence: string, { scans }: Changes): Promise<void> {
    const { store } = this.world;
    for (const change of scans) this.world.loader.forget(sequence, change);
    if (scans.length === 0 || sequence !== store.state.sequence) return;
    const { cloud, current } = store.state;
    const still = await this.adopting.reread(
      sequence,
      cloud.scans.filter((scan) => scans.some((change) => sameScan(change, scan))),
    );
    // Another window of this browser is the same person: what can be undone here is what was done there.
    await Promise.all([this.queueing.read(), this.readHistory(sequence)]);
    const here = scans.find((change) => sameScan(change, current));
    if (here !== undefined && still)
      tell(this.world, `${here.author} changed this scan in another window; you see the newer state.`);
  }
}

/** A browser has few connections to a server for all of its tabs: one that isn't seen must not hold one. */
function pollWhileSeen(ended: AbortSignal): Poll {
  const poll = new AbortController();
  const stop = (): void => {
    if (document.hidden || ended.aborted) poll.abort();
  };
  ended.addEventListener("abort", stop);
  document.addEventListener("visibilitychange", stop);
  const end = (): void => {
    ended.removeEventListener("abort", stop);
    document.removeEventListener("visibilitychange", stop);
  };
  return { signal: poll.signal, stop: () => poll.abort(), end };
}

interface Poll {
  readonly signal: AbortSignal;
  readonly stop: () => void;
  readonly end: () => void;
}

function pause(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}

/** Resolves once the page is seen. */
function seen(): Promise<void> {
  if (!document.hidden) return Promise.resolve();
  return new Promise((resolve) => {
    document.addEventListener("visibilitychange", () => resolve(), { once: true });
  });
}
