/** Corrections: strokes, undo and redo, marks of review. Nothing counts before the server has said so. */

import { Conflict } from "../api/errors.js";
import { randomName } from "../api/session.js";
import type { ScanCorrections, StrokeAnswer, StrokeRequest } from "../api/types.js";
import { findScan, maskOf, pointsByScan, withScans } from "../data/cloud.js";
import { ARTIFACT, type Choice, PLAUSIBLE } from "../data/labels.js";
import { sameScan, type Scan, withCorrections } from "../data/scan.js";
import { keepStrokes, keptStrokes } from "../history/keep.js";
import { alreadyThere, Outbox, type OutboxStatus, type Pending } from "../history/outbox.js";
import { progressOf, withCorrectionCounts, withReviewed } from "../queue/queue.js";
import { countOf } from "../selection/mask.js";
import type { Navigation } from "./navigation.js";
import { complain, tell, type World } from "./world.js";

export class Correcting {
  private readonly outbox: Outbox;
  private turn: Promise<void> = Promise.resolve();

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
  ) {
    const { api } = world;
    this.outbox = new Outbox(
      {
        send: ({ sequence, stroke }) => api.stroke(sequence, stroke),
        keep: keepStrokes,
        saved: (pending, answer) => this.saved(pending, answer),
        status: (status, waiting) => this.heed(status, waiting),
      },
      keptStrokes(),
    );
  }

  /** Sets the selected detections to a label (`null`: the machine's guess). */
  async apply(choice: Choice, tool: string): Promise<void> {
    const { store } = this.world;
    const { selection, outbox } = store.state;
    if (countOf(selection) === 0 || outbox.kind === "conflict") return;
    const stroke = this.strokeOf(selection, choice, tool);
    store.set({ selection: new Uint8Array(selection.length) });
    await this.outbox.add([stroke]);
  }

  /** Makes the selected plausible ones artifacts and the other way round, as one step. */
  async flip(tool: string): Promise<void> {
    const { store } = this.world;
    const { selection, cloud, labels, outbox } = store.state;
    if (countOf(selection) === 0 || outbox.kind === "conflict") return;
    const group = randomName();
    const halves = [PLAUSIBLE, ARTIFACT].map((label) => {
      const wrong = label === PLAUSIBLE ? "artifact" : "plausible";
      const half = selection.map((chosen, i) => chosen & Number(labels.truth(cloud.label[i]) === wrong));
      return { label, half };
    });
    const strokes = halves
      .filter(({ half }) => countOf(half) > 0)
      .map(({ label, half }) => this.strokeOf(half, label, tool, group));
    store.set({ selection: new Uint8Array(selection.length) });
    await this.outbox.add(strokes);
  }

  undo(): Promise<void> {
    return this.inTurn("undo");
  }

  redo(): Promise<void> {
    return this.inTurn("redo");
  }

  retry(): Promise<void> {
    return this.outbox.retry();
  }

  dropWaiting(): Promise<void> {
    return this.outbox.drop();
  }

  applyAnyway(protect: boolean): Promise<void> {
    return this.outbox.applyAnyway(protect);
  }

  /** Marks the scan as reviewed, or takes the mark back. */
  async review(reviewed: boolean): Promise<boolean> {
    const { store, api, loader } = this.world;
    const { sequence, cloud, loading } = store.state;
    const scan = cloud.scans[0];
    // While another scan is coming, the one on screen isn't the one that is meant.
    if (scan === undefined || loading || !this.free("mark")) return false;
    store.set({ busy: true });
    try {
      const answer = await api.reviewed(sequence, scan, reviewed, scan.revision);
      const marked: Scan = { ...scan, reviewed: answer.reviewed };
      loader.keep(sequence, marked);
      const { cloud: now, scans } = store.state;
      store.set({
        cloud: withScans(now, [marked]),
        scans: withReviewed(scans, scan, answer.reviewed),
        progress: answer.progress,
      });
      return true;
    } catch (error) {
      await this.refused("marked", error);
      return false;
    } finally {
      store.set({ busy: false });
    }
  }

  async reviewAndGoOn(): Promise<void> {
    if (await this.review(true)) await this.navigation.nextNeedy();
  }

  /** Takes over what the server says of some scans' corrections. */
  async adopt(sequence: string, answered: readonly ScanCorrections[]): Promise<void> {
    const { store, loader } = this.world;
    if (sequence !== store.state.sequence) return answered.forEach((id) => loader.forget(sequence, id));
    const { cloud, scans } = store.state;
    const onScreen = cloud.scans.flatMap((scan) => {
      const answer = answered.find((other) => sameScan(other, scan));
      return answer === undefined ? [] : [{ scan, now: withCorrections(scan, answer) }];
    });
    const changed = onScreen.flatMap(({ now }) => (now === null ? [] : [now]));
    for (const answer of answered) loader.forget(sequence, answer);
    for (const scan of changed) loader.keep(sequence, scan);
    const counted = withCorrectionCounts(scans, answered);
    store.set({ cloud: withScans(cloud, changed), scans: counted, progress: progressOf(counted) });
    await this.reread(
      sequence,
      onScreen.filter(({ now }) => now === null).map(({ scan }) => scan),
    );
  }

  /** Reads scans on screen anew. */
  async reread(sequence: string, stale: readonly Scan[]): Promise<void> {
    const { store, loader } = this.world;
    for (const scan of stale) loader.forget(sequence, scan);
    const fresh = await Promise.all(stale.map((scan) => loader.scan(sequence, scan)));
    if (fresh.length > 0) store.set({ cloud: withScans(store.state.cloud, fresh) });
  }

  private strokeOf(mask: Uint8Array, label: Choice, tool: string, group?: string): Pending {
    const { cloud, protect, sequence } = this.world.store.state;
    const points = pointsByScan(cloud, mask);
    const base = cloud.scans
      .filter((scan) => points.some((other) => sameScan(scan, other)))
      .map(({ radar, scan, revision }) => ({ radar, scan, revision }));
    // Going back to the machine's guess is about corrected detections, so it can't spare them.
    const stroke: StrokeRequest = { tool, protect: protect && label !== null, label, base, points };
    return { sequence, stroke: group === undefined ? stroke : { ...stroke, group } };
  }

  private saved({ sequence, stroke }: Pending, answer: StrokeAnswer): void {
    const { store } = this.world;
    store.set({ connected: true });
    if (sequence === store.state.sequence) store.set({ history: answer.history });
    this.adopt(sequence, answer.scans).catch((error: unknown) => complain(this.world, error));
    const asked = stroke.points.reduce((sum, { points }) => sum + points.length, 0);
    if (answer.changed < asked && stroke.protect) {
      const spared = asked - answer.changed;
      tell(
        this.world,
        `${answer.changed} changed; ${spared} had this label or were corrected already and are protected.`,
      );
    }
  }

  private heed(status: OutboxStatus, waiting: readonly Pending[]): void {
    const { store } = this.world;
    store.set({ outbox: status, waiting, connected: status.kind === "gone" ? false : store.state.connected });
    if (status.kind === "conflict")
      this.meetConflict(status.pending, status).catch((error: unknown) => complain(this.world, error));
  }

  private async meetConflict(pending: Pending, { body }: Extract<OutboxStatus, { kind: "conflict" }>): Promise<void> {
    const { store, api } = this.world;
    await this.adopt(pending.sequence, body.scans);
    if (alreadyThere(pending, body)) {
      await this.outbox.drop();
      if (pending.sequence === store.state.sequence) store.set({ history: await api.history(pending.sequence) });
      return;
    }
    if (pending.sequence !== store.state.sequence) return;
    const { base, points } = pending.stroke;
    if (!base.some((scan) => findScan(store.state.cloud, scan) >= 0)) await this.navigation.goTo(base[0]);
    store.set({ selection: maskOf(store.state.cloud, points) });
  }

  /** Undo and redo wait for each other, so that a key may be pressed quickly. */
  private inTurn(what: "undo" | "redo"): Promise<void> {
    this.turn = this.turn.then(() => this.takeBack(what)).catch((error: unknown) => complain(this.world, error));
    return this.turn;
  }

  private async takeBack(what: "undo" | "redo"): Promise<void> {
    const { store, api } = this.world;
    const { sequence, history } = store.state;
    if (!this.free(what) || history[what] === null) return;
    store.set({ busy: true });
    try {
      const answer = await api[what](sequence);
      store.set({ history: answer.history });
      await this.adopt(sequence, answer.scans);
      const elsewhere = answer.scans.every((scan) => !store.state.cloud.scans.some((other) => sameScan(other, scan)));
      if (elsewhere && answer.scans.length > 0) await this.navigation.goTo(answer.scans[0]);
    } catch (error) {
      await this.refused(what === "undo" ? "undone" : "redone", error);
    } finally {
      store.set({ busy: false });
    }
  }

  /** Whether nothing waits to be saved, which must come first. */
  private free(what: string): boolean {
    if (this.outbox.idle) return true;
    if (this.outbox.status.kind !== "saving") complain(this.world, `Before ${what}: some strokes are not saved yet.`);
    return false;
  }

  private async refused(done: string, error: unknown): Promise<void> {
    if (error instanceof Conflict) {
      const { sequence } = this.world.store.state;
      await this.adopt(sequence, error.body.scans).catch((failed: unknown) => complain(this.world, failed));
      const by = error.body.conflict === null ? "" : ` (${error.body.conflict.author}, ${error.body.conflict.tool})`;
      complain(this.world, `Not ${done}${by}: ${error.message}`);
    } else {
      complain(this.world, error);
    }
  }
}
