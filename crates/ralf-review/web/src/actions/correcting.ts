/** Strokes: what is selected gets a label. Nothing counts before the server has said so. */

import { randomName } from "../api/session.js";
import type { BaseRevision, Opinion, ScanPoints, StrokeAnswer, StrokeRequest } from "../api/types.js";
import { findScan, maskOf, pointsByScan } from "../data/cloud.js";
import { ARTIFACT, type Choice, PLAUSIBLE } from "../data/labels.js";
import { baseOf, pointsOf } from "../data/opinion.js";
import type { ReplayPart } from "../data/replay.js";
import type { Verdict } from "../data/rules.js";
import { sameScan } from "../data/scan.js";
import type { Keeper } from "../history/keep.js";
import { type Errand, type Met, Outbox, type OutboxStatus, type Pending } from "../history/outbox.js";
import { inPieces } from "../history/pieces.js";
import { countOf } from "../selection/mask.js";
import type { Adopting } from "./adopting.js";
import type { Navigation } from "./navigation.js";
import { complain, readOnly, tell, type World } from "./world.js";

/** The tool by which the server knows that a disagreement is settled. */
const SETTLE = "settle";

export class Correcting {
  private readonly outbox: Outbox;

  constructor(
    private readonly world: World,
    private readonly navigation: Navigation,
    private readonly adopting: Adopting,
    keeper: Keeper,
  ) {
    const { api } = world;
    const unkept = (error: unknown): void =>
      complain(world, `This browser can't keep unsaved strokes over a reload: ${String(error)}`);
    this.outbox = new Outbox(
      {
        send: ({ sequence, stroke }) => api.stroke(sequence, stroke),
        keep: (waiting) => void keeper.keep(waiting).catch(unkept),
        saved: (pending, answer) => this.saved(pending, answer),
        status: (status, waiting) => this.heed(status, waiting),
      },
      keeper.found,
    );
  }

  /** Sets the selected detections to a label (`null`: the machine's guess), and says why it is so. */
  async apply(choice: Choice, tool: string, cause: string | null = null): Promise<void> {
    const { store } = this.world;
    const { selection, outbox } = store.state;
    if (countOf(selection) === 0 || outbox.kind === "conflict" || readOnly(this.world)) return;
    const { sequence, stroke } = this.strokeOf(selection, choice, tool);
    store.set({ selection: new Uint8Array(selection.length) });
    await this.add([{ sequence, stroke: because(stroke, cause) }]);
  }

  /** Makes the selected plausible ones artifacts and the other way round, as one step. */
  async flip(tool: string): Promise<void> {
    const { store } = this.world;
    const { selection, cloud, labels, outbox } = store.state;
    if (countOf(selection) === 0 || outbox.kind === "conflict" || readOnly(this.world)) return;
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
    await this.add(strokes);
  }

  /**
   * Makes what an opinion would change so, as one step, and says whether it does. It rests on what was said when the
   * opinion was made: whatever was said since is a conflict.
   */
  async applyOpinion(opinion: Opinion): Promise<boolean> {
    const { store } = this.world;
    const { cloud, sequence, outbox } = store.state;
    if (opinion.changes.length === 0 || outbox.kind === "conflict" || readOnly(this.world)) return false;
    const group = randomName();
    const strokes = [PLAUSIBLE, ARTIFACT].flatMap((label) => {
      const points = pointsOf(opinion.changes.filter((change) => change.label === label));
      const base = baseOf(opinion, points);
      const stroke = { id: randomName(), tool: "opinion", protect: true, label, base, points, group };
      return points.length === 0 ? [] : [{ sequence, stroke }];
    });
    store.set({ selection: new Uint8Array(cloud.count), opinion: null, opinionAt: -1 });
    await this.add(strokes);
    return true;
  }

  /** Says who is right where two people said different things: those who have said so before say it again. */
  settle(
    points: readonly ScanPoints[],
    base: readonly BaseRevision[],
    label: Choice,
    cause: string | null = null,
  ): Promise<boolean> {
    return this.answerAll(points, base, { label, tool: SETTLE, protect: false }, cause);
  }

  /** Says what many detections are that one question was about; nobody's corrections are among them. */
  answerKind(points: readonly ScanPoints[], base: readonly BaseRevision[], label: Choice): Promise<boolean> {
    return this.answerAll(points, base, { label, tool: "kind", protect: true });
  }

  /** One stroke on detections wherever they are; those that have the label already are noted, too. */
  private async answerAll(
    points: readonly ScanPoints[],
    base: readonly BaseRevision[],
    said: Pick<StrokeRequest, "label" | "tool" | "protect">,
    cause: string | null = null,
  ): Promise<boolean> {
    const { store } = this.world;
    const { sequence, outbox, cloud } = store.state;
    if (points.length === 0 || outbox.kind === "conflict" || readOnly(this.world)) return false;
    const stroke = { ...said, id: randomName(), confirm: true, base: baseOf({ base }, points), points };
    // It is answered: a second press must not answer what isn't on screen once more.
    store.set({ selection: new Uint8Array(cloud.count), disputed: null, kind: null });
    await this.add([{ sequence, stroke: because(stroke, cause) }]);
    return true;
  }

  /** Makes what a rule would change so, in each sequence as one stroke. */
  async replay(parts: readonly ReplayPart[], { label, cause }: Verdict): Promise<void> {
    const strokes = parts.map(({ sequence, points, base }) => {
      const stroke = { id: randomName(), tool: "rule", protect: true, label, base, points };
      return { sequence, stroke: because(stroke, cause) };
    });
    await this.add(strokes);
  }

  private add(strokes: readonly Pending[]): Promise<void> {
    return this.outbox.add(strokes.flatMap((pending) => inPieces(pending)));
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

  /** Goes to what the stroke in conflict would change, wherever it is. */
  async showMet(): Promise<void> {
    const { sequence, outbox } = this.world.store.state;
    if (outbox.kind !== "conflict") return;
    const { pending } = outbox;
    if (pending.sequence !== sequence) await this.navigation.open(pending.sequence, pending.stroke.base[0]);
    await this.selectMet(outbox);
  }

  /** Makes an edit of another kind in its turn; that it can't, for strokes before it can't be saved, is told. */
  inTurn(what: string, errand: Omit<Errand, "refuse">): Promise<void> {
    return new Promise((resolve) => {
      const failed = (error: unknown): null => {
        complain(this.world, error);
        return null;
      };
      const run: Errand["run"] = (base) => errand.run(base).catch(failed).finally(resolve);
      const refuse = (): void => {
        complain(this.world, `Before ${what}: some strokes are not saved yet.`);
        resolve();
      };
      void this.outbox.ask({ ...errand, run, refuse });
    });
  }

  /** Waits until nothing is left to be saved, which must come first; false where it can't be. */
  async free(what: string): Promise<boolean> {
    let free = this.outbox.idle;
    const run = (): Promise<null> => {
      free = true;
      return Promise.resolve(null);
    };
    if (!free) await this.inTurn(what, { sequence: this.world.store.state.sequence, base: [], run });
    return free;
  }

  private strokeOf(mask: Uint8Array, label: Choice, tool: string, group?: string): Pending {
    const { cloud, protect, sequence } = this.world.store.state;
    const points = pointsByScan(cloud, mask);
    const base = cloud.scans
      .filter((scan) => points.some((other) => sameScan(scan, other)))
      .map(({ radar, scan, revision, table }) => ({ radar, scan, revision, content: table.header.content }));
    // Going back to the machine's guess is about corrected detections, so it can't spare them.
    const stroke: StrokeRequest = { id: randomName(), tool, protect: protect && label !== null, label, base, points };
    return { sequence, stroke: group === undefined ? stroke : { ...stroke, group } };
  }

  private saved({ sequence, stroke }: Pending, answer: StrokeAnswer): void {
    const { store } = this.world;
    store.set({ link: { kind: "fine" } });
    if (sequence === store.state.sequence) store.set({ history: answer.history });
    this.adopting.adopt(sequence, answer.scans).catch((error: unknown) => complain(this.world, error));
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
    store.set({ outbox: status, waiting, link: status.kind === "gone" ? status.link : store.state.link });
    if (status.kind === "conflict") this.meetConflict(status).catch((error: unknown) => complain(this.world, error));
  }

  private async meetConflict(met: Met): Promise<void> {
    if (met.body.stale) return this.adopting.readAllAnew();
    await this.adopting.adopt(met.pending.sequence, met.body.scans);
    await this.selectMet(met);
  }

  /** Selects what the stroke in conflict would change; whoever is in another sequence is left there. */
  private async selectMet(met: Met): Promise<void> {
    const { store } = this.world;
    const { sequence, stroke } = met.pending;
    const isAsked = (): boolean => store.state.outbox === met && store.state.sequence === sequence;
    if (!isAsked()) return;
    const { base, points } = stroke;
    if (!base.some((scan) => findScan(store.state.cloud, scan) >= 0)) await this.navigation.goTo(base[0]);
    if (isAsked()) store.set({ selection: maskOf(store.state.cloud, points) });
  }
}

/** The stroke with why detections are artifacts, where that is said. */
function because(stroke: StrokeRequest, cause: string | null): StrokeRequest {
  return cause === null ? stroke : { ...stroke, cause };
}
