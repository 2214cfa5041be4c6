/**
 * Strokes on their way to the server, one after the other. A stroke stays here, and in the browser's storage, until
 * the server has said that it's on disk; nobody's answer, a refusal and a conflict keep it too, until a person
 * decides. Each has a name by which the server knows it, so that one whose answer was lost is not made twice when it
 * is sent again.
 */

import { Conflict, Elsewhere, type Link, linkAfter, messageOf, ServerGone } from "../api/errors.js";
import type {
  BaseRevision,
  ConflictBody,
  ScanCorrections,
  ScanPoints,
  StrokeAnswer,
  StrokeRequest,
} from "../api/types.js";
import { sameScan } from "../data/scan.js";

export interface Pending {
  readonly sequence: string;
  readonly stroke: StrokeRequest;
}

export type OutboxStatus =
  | { readonly kind: "idle" }
  | { readonly kind: "saving" }
  /** Nobody is there who could save it. */
  | { readonly kind: "gone"; readonly link: Link }
  | { readonly kind: "refused"; readonly message: string }
  | { readonly kind: "conflict"; readonly body: ConflictBody; readonly pending: Pending };

export interface OutboxWorld {
  readonly send: (pending: Pending) => Promise<StrokeAnswer>;
  /** Keeps what isn't saved over a reload, in the order of the calls. */
  readonly keep: (waiting: readonly Pending[]) => void;
  readonly saved: (pending: Pending, answer: StrokeAnswer) => void;
  readonly status: (status: OutboxStatus, waiting: readonly Pending[]) => void;
}

export class Outbox {
  private waiting: readonly Pending[];
  private current: OutboxStatus = { kind: "idle" };

  /** `kept`: what an earlier life of the page left unsaved; it waits for `retry`. */
  constructor(
    private readonly world: OutboxWorld,
    kept: readonly Pending[] = [],
  ) {
    this.waiting = kept;
    this.say(kept.length === 0 ? { kind: "idle" } : { kind: "gone", link: { kind: "gone" } });
  }

  get idle(): boolean {
    return this.waiting.length === 0;
  }

  get status(): OutboxStatus {
    return this.current;
  }

  add(strokes: readonly Pending[]): Promise<void> {
    this.waiting = [...this.waiting, ...strokes];
    this.world.keep(this.waiting);
    if (this.current.kind === "idle") return this.run();
    this.say(this.current);
    return Promise.resolve();
  }

  /** Tries again after the server was gone or refused. */
  retry(): Promise<void> {
    return this.current.kind === "gone" || this.current.kind === "refused" ? this.run() : Promise.resolve();
  }

  /** Gives the first waiting stroke up, with those of its group, because a person said so. */
  drop(): Promise<void> {
    const [first] = this.waiting;
    if (first === undefined || this.current.kind === "saving") return Promise.resolve();
    this.waiting = this.waiting.filter((pending) => !together(first, pending));
    this.world.keep(this.waiting);
    return this.run();
  }

  /** After a conflict: sets the stroke on top of the newer state. */
  applyAnyway(protect: boolean): Promise<void> {
    // What was chosen on other detections means nothing on these.
    if (this.current.kind !== "conflict" || this.current.body.stale) return Promise.resolve();
    const newest = rebased(this.waiting, this.current.body.scans);
    this.waiting = newest.map((pending) =>
      together(newest[0], pending) ? { ...pending, stroke: { ...pending.stroke, protect } } : pending,
    );
    this.world.keep(this.waiting);
    return this.run();
  }

  private async run(): Promise<void> {
    while (this.waiting.length > 0) {
      this.say({ kind: "saving" });
      const pending = this.waiting[0];
      try {
        this.finish(pending, await this.world.send(pending));
      } catch (error) {
        return this.say(statusAfter(error, pending));
      }
    }
    this.say({ kind: "idle" });
  }

  private finish(pending: Pending, answer: StrokeAnswer): void {
    this.waiting = afterOwn(this.waiting.slice(1), pending, answer.scans);
    this.world.keep(this.waiting);
    this.world.saved(pending, answer);
  }

  private say(status: OutboxStatus): void {
    this.current = status;
    this.world.status(status, this.waiting);
  }
}

/** The detections of strokes, wherever they are. */
export function pointsOf(strokes: readonly Pending[]): readonly ScanPoints[] {
  return strokes.flatMap(({ stroke }) => stroke.points);
}

/** Whether both are one step to the person who made them. */
function together(first: Pending, other: Pending): boolean {
  return first === other || (first.stroke.group !== undefined && first.stroke.group === other.stroke.group);
}

function statusAfter(error: unknown, pending: Pending): OutboxStatus {
  if (error instanceof Conflict) return { kind: "conflict", body: error.body, pending };
  if (error instanceof ServerGone || error instanceof Elsewhere) return { kind: "gone", link: linkAfter(error) };
  return { kind: "refused", message: messageOf(error) };
}

/**
 * Strokes made while an own one was under way rest on the revision before it; once that is saved they rest on the
 * one after it. A stroke that rests on any other revision keeps it, so that another's change in between still shows.
 */
export function afterOwn(
  waiting: readonly Pending[],
  own: Pending,
  answered: readonly ScanCorrections[],
): readonly Pending[] {
  const was = new Map(own.stroke.base.map((base) => [`${base.radar}/${base.scan}`, base.revision]));
  const rests = (base: BaseRevision): boolean => was.get(`${base.radar}/${base.scan}`) === base.revision;
  return waiting.map((pending) => {
    if (pending.sequence !== own.sequence || !pending.stroke.base.some(rests)) return pending;
    const base = pending.stroke.base.map((one) => (rests(one) ? atRevision(one, answered) : one));
    return { ...pending, stroke: { ...pending.stroke, base } };
  });
}

/** The same strokes on the newest revisions. */
function rebased(waiting: readonly Pending[], newest: readonly ScanCorrections[]): readonly Pending[] {
  return waiting.map((pending) => ({
    ...pending,
    stroke: { ...pending.stroke, base: pending.stroke.base.map((base) => atRevision(base, newest)) },
  }));
}

function atRevision(base: BaseRevision, newest: readonly ScanCorrections[]): BaseRevision {
  const found = newest.find((scan) => sameScan(scan, base));
  return found === undefined ? base : { ...base, revision: found.revision };
}
