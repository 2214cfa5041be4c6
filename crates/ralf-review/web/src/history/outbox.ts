/**
 * Strokes on their way to the server, one after the other. A stroke stays here, and in the browser's storage, until
 * the server has said that it's on disk; nobody's answer, a refusal and a conflict keep it too, until a person
 * decides. Each has a name by which the server knows it, so that one whose answer was lost is not made twice when it
 * is sent again.
 */

import { Conflict, isAway, type Link, linkAfter, messageOf } from "../api/errors.js";
import type {
  BaseRevision,
  ConflictBody,
  ScanCorrections,
  ScanPoints,
  StrokeAnswer,
  StrokeRequest,
} from "../api/types.js";
import { sameScan, type Scan, scanKey } from "../data/scan.js";
import { Overlaid } from "./overlaid.js";

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
  | Met;

/** Somebody else's edit came first. */
export interface Met {
  readonly kind: "conflict";
  readonly body: ConflictBody;
  readonly pending: Pending;
}

export interface OutboxWorld {
  readonly send: (pending: Pending) => Promise<StrokeAnswer>;
  /** Keeps what isn't saved over a reload, in the order of the calls. */
  readonly keep: (waiting: readonly Pending[]) => void;
  readonly saved: (pending: Pending, answer: StrokeAnswer) => void;
  readonly status: (status: OutboxStatus, waiting: readonly Pending[]) => void;
}

/** What an edit rests on. */
export interface Ground {
  readonly sequence: string;
  readonly base: readonly BaseRevision[];
}

/** Where an edit has led. */
export interface Moved extends Ground {
  readonly scans: readonly ScanCorrections[];
}

/** An edit of another kind: it comes after the strokes that were made before it, and before those made after it. */
export interface Errand extends Ground {
  /** `base`: as it is after the edits before it; `null`: nothing has moved. Never rejects. */
  readonly run: (base: readonly BaseRevision[]) => Promise<Moved | null>;
  /** The strokes before it can't be saved now: it is given up. */
  readonly refuse: () => void;
}

type Item = Pending | Errand;

export class Outbox {
  private items: readonly Item[];
  private current: OutboxStatus = { kind: "idle" };
  private readonly overlaid = new Overlaid();

  /** `kept`: what an earlier life of the page left unsaved; it waits for `retry`. */
  constructor(
    private readonly world: OutboxWorld,
    kept: readonly Pending[] = [],
  ) {
    this.items = kept;
    this.say(kept.length === 0 ? { kind: "idle" } : { kind: "gone", link: { kind: "gone" } });
  }

  get idle(): boolean {
    return this.items.length === 0;
  }

  add(strokes: readonly Pending[]): Promise<void> {
    this.items = [...this.items, ...strokes];
    this.keep();
    return this.goOn();
  }

  /** Does something in its turn; where strokes wait for something else than their own turn, it is refused. */
  ask(errand: Errand): Promise<void> {
    if (this.current.kind === "idle" || this.current.kind === "saving") {
      this.items = [...this.items, errand];
      return this.goOn();
    }
    errand.refuse();
    return Promise.resolve();
  }

  /** Tries again after the server was gone or refused. */
  retry(): Promise<void> {
    return this.current.kind === "gone" || this.current.kind === "refused" ? this.run() : Promise.resolve();
  }

  /** Gives strokes up, because a person said so: see `givenUp`. */
  drop(): Promise<void> {
    const given = new Set<Item>(givenUp(this.current, this.waiting));
    if (given.size === 0) return Promise.resolve();
    this.items = this.items.filter((item) => !given.has(item));
    this.keep();
    return this.run();
  }

  /**
   * After a conflict: sets the stroke on top of the newer state, with its group. The others keep what they were made
   * on, for nobody was asked about them: each is a conflict of its own.
   */
  applyAnyway(protect: boolean): Promise<void> {
    // What was chosen on other detections means nothing on these.
    if (this.current.kind !== "conflict" || this.current.body.stale) return Promise.resolve();
    const { body, pending } = this.current;
    this.items = this.waiting.map((other) => (together(pending, other) ? onTop(other, body.scans, protect) : other));
    this.keep();
    return this.run();
  }

  private get waiting(): readonly Pending[] {
    return this.items.filter(isStroke);
  }

  private keep(): void {
    this.world.keep(this.waiting);
  }

  private goOn(): Promise<void> {
    if (this.current.kind === "idle") return this.run();
    this.say(this.current);
    return Promise.resolve();
  }

  private async run(): Promise<void> {
    for (let next = this.items[0]; next !== undefined; next = this.items[0]) {
      this.say({ kind: "saving" });
      const trouble = isStroke(next) ? await this.save(next) : await this.do(next);
      if (trouble !== null) return this.stop(trouble);
    }
    this.say({ kind: "idle" });
  }

  private async save(pending: Pending): Promise<OutboxStatus | null> {
    try {
      const answer = await this.world.send(pending);
      const { sequence, stroke } = pending;
      this.finish({ sequence, base: stroke.base, scans: answer.scans });
      this.keep();
      this.world.saved(pending, answer);
      return null;
    } catch (error) {
      return this.statusAfter(error, pending);
    }
  }

  private async do({ base, run }: Errand): Promise<null> {
    this.finish(await run(base));
    return null;
  }

  /** Takes the first away; those behind it rest on what it led to. */
  private finish(moved: Moved | null): void {
    const behind = this.items.slice(1);
    this.items = moved === null ? behind : behind.map((item) => afterOwn(item, moved));
    if (moved !== null) this.overlaid.cover(moved.sequence, moved.base, moved.scans);
  }

  private statusAfter(error: unknown, pending: Pending): OutboxStatus {
    if (error instanceof Conflict)
      return { kind: "conflict", body: this.overlaid.named(pending.sequence, error.body), pending };
    if (isAway(error)) return { kind: "gone", link: linkAfter(error) };
    return { kind: "refused", message: messageOf(error) };
  }

  private stop(trouble: OutboxStatus): void {
    const given = this.items.flatMap((item) => (isStroke(item) ? [] : [item]));
    this.items = this.waiting;
    this.say(trouble);
    for (const errand of given) errand.refuse();
  }

  private say(status: OutboxStatus): void {
    this.current = status;
    this.world.status(status, this.waiting);
  }
}

function isStroke(item: Item): item is Pending {
  return "stroke" in item;
}

/**
 * What a person gives up who drops a stroke now, with those of its group: the first one, which is refused or in
 * conflict; where no server is there, the last one, for that is the one that somebody thinks better of.
 */
export function givenUp(status: OutboxStatus, waiting: readonly Pending[]): readonly Pending[] {
  const one = status.kind === "gone" ? waiting.at(-1) : waiting[0];
  if (one === undefined || status.kind === "saving") return [];
  return waiting.filter((pending) => together(one, pending));
}

/** The detections of strokes, wherever they are. */
export function pointsOf(strokes: readonly Pending[]): readonly ScanPoints[] {
  return strokes.flatMap(({ stroke }) => stroke.points);
}

/**
 * Those in one sequence: radars have the same names in another, and scans the same numbers. Without those of a scan on
 * screen that holds other detections than they were chosen among.
 */
export function pointsIn(sequence: string, scans: readonly Scan[], strokes: readonly Pending[]): readonly ScanPoints[] {
  const now = new Map(scans.map((scan) => [scanKey(scan), scan.table.header.content]));
  return strokes.flatMap((pending) => {
    const { base, points } = pending.stroke;
    if (pending.sequence !== sequence) return [];
    const others = new Set(base.filter((scan) => isOther(scan.content, now.get(scanKey(scan)))).map(scanKey));
    return points.filter((part) => !others.has(scanKey(part)));
  });
}

function isOther(then: string | undefined, now: string | undefined): boolean {
  return then !== undefined && now !== undefined && then !== now;
}

/** Whether both are one step to the person who made them. */
function together(first: Pending, other: Pending): boolean {
  return first === other || (first.stroke.group !== undefined && first.stroke.group === other.stroke.group);
}

/**
 * What was asked for while an own edit was under way rests on the revision before it; once that is saved it rests on
 * the one after it. What rests on any other revision keeps it, so that another's change in between still shows.
 */
export function afterOwn<Some extends Item>(item: Some, own: Moved): Some {
  const was = new Map(own.base.map((base) => [`${base.radar}/${base.scan}`, base.revision]));
  const rests = (base: BaseRevision): boolean => was.get(`${base.radar}/${base.scan}`) === base.revision;
  const before = isStroke(item) ? item.stroke.base : item.base;
  if (item.sequence !== own.sequence || !before.some(rests)) return item;
  const base = before.map((one) => (rests(one) ? atRevision(one, own.scans) : one));
  return isStroke(item) ? { ...item, stroke: { ...item.stroke, base } } : { ...item, base };
}

/** The same stroke on the newest revisions. */
function onTop({ sequence, stroke }: Pending, newest: readonly ScanCorrections[], protect: boolean): Pending {
  return { sequence, stroke: { ...stroke, protect, base: stroke.base.map((base) => atRevision(base, newest)) } };
}

function atRevision(base: BaseRevision, newest: readonly ScanCorrections[]): BaseRevision {
  const found = newest.find((scan) => sameScan(scan, base));
  return found === undefined ? base : { ...base, revision: found.revision };
}
