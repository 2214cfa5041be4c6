/** The server's interface, typed; every failure is one of `errors.ts` or an abort. */

import { Conflict, Elsewhere, Refused, ServerGone, TokenMissing } from "./errors.js";
import type { Kinds } from "./kinds.js";
import type { Session } from "./session.js";
import { decodeTable, type Table } from "./table.js";
import type {
  Changes,
  ConflictBody,
  Disagreements,
  Doubtful,
  MarkRequest,
  History,
  LidarHeader,
  Opinion,
  Past,
  Progress,
  Queue,
  Recording,
  ReviewedAnswer,
  ScanHeader,
  ScanId,
  ScansAround,
  StrokeAnswer,
  StrokeRequest,
  ThingInImageHeader,
  ThingsHeader,
  Workday,
} from "./types.js";

/** An edit is answered in moments and a poll within 25 s: after so long, ms, nothing comes over this connection. */
const PATIENCE_MS = 60_000;

export interface Call {
  readonly signal?: AbortSignal | undefined;
}

/** A place of the odometry frame and how far around it is looked, m. */
export interface Near {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
}

export class Api {
  /** `store`: the corrections that are meant by all that is asked; `null` before it is known which are served. */
  constructor(
    private readonly session: Session,
    private readonly store: string | null,
  ) {}

  recording(): Promise<Recording> {
    return this.json("GET", "recording");
  }

  queue(sequence: string): Promise<Queue> {
    return this.json("GET", `${inSequence(sequence)}/queue`);
  }

  /** The thing of every detection, and the doubtful things. */
  things(sequence: string): Promise<Table<ThingsHeader>> {
    return this.table(`${inSequence(sequence)}/things`);
  }

  doubtful(sequence: string): Promise<Doubtful> {
    return this.json("GET", `${inSequence(sequence)}/things/doubtful`);
  }

  /** What the labels would be, after what people said; the first time it takes a while. */
  opinion(sequence: string, tNs: string): Promise<Opinion> {
    return this.json("GET", `${inSequence(sequence)}/opinion?${new URLSearchParams({ t_ns: tNs })}`);
  }

  /** Which detections all over the sequence one question can be about; `passed`: which have been passed over. */
  kinds(sequence: string, tNs: string, passed: readonly string[]): Promise<Kinds> {
    const query = new URLSearchParams({ t_ns: tNs, passed: passed.join(",") });
    return this.json("GET", `${inSequence(sequence)}/kinds?${query}`);
  }

  /** How far people agree who labelled the same scans, and where they don't. */
  disagreements(sequence: string): Promise<Disagreements> {
    return this.json("GET", `${inSequence(sequence)}/disagreements`);
  }

  /** Who has done how much, in all sequences. */
  people(): Promise<{ readonly days: readonly Workday[] }> {
    return this.json("GET", "people");
  }

  /** What was ever said of a detection, or of all that belong together with it. */
  past(sequence: string, { radar, scan }: ScanId, point: number, thing: boolean): Promise<Past> {
    const path = `${inSequence(sequence)}/radars/${part(radar)}/scans/${scan}/detections/${point}/said`;
    return this.json("GET", `${path}?thing=${thing}`);
  }

  progress(sequence: string): Promise<Progress> {
    return this.json("GET", `${inSequence(sequence)}/progress`);
  }

  history(sequence: string): Promise<History> {
    return this.json("GET", `${inSequence(sequence)}/history`);
  }

  scan(sequence: string, { radar, scan }: ScanId, call?: Call): Promise<Table<ScanHeader>> {
    return this.table(`${inSequence(sequence)}/radars/${part(radar)}/scans/${scan}`, call);
  }

  lidar(sequence: string, name: string, scan: number, call?: Call): Promise<Table<LidarHeader>> {
    return this.table(`${inSequence(sequence)}/lidars/${part(name)}/scans/${scan}`, call);
  }

  /** What several scans around one have seen stand still. */
  lidarMap(sequence: string, name: string, scan: number, call?: Call): Promise<Table<LidarHeader>> {
    return this.table(`${inSequence(sequence)}/lidars/${part(name)}/scans/${scan}/around`, call);
  }

  /** The points of a scan near a place. */
  lidarNear(sequence: string, name: string, scan: number, near: Near): Promise<Table<LidarHeader>> {
    const query = new URLSearchParams(Object.entries(near).map(([key, value]) => [key, String(value)]));
    return this.table(`${inSequence(sequence)}/lidars/${part(name)}/scans/${scan}/near?${query}`);
  }

  async image(sequence: string, camera: string, image: number, call?: Call): Promise<Blob> {
    const answer = await this.send("GET", `${inSequence(sequence)}/cameras/${part(camera)}/images/${image}`, call);
    return received(answer.blob());
  }

  projections(
    sequence: string,
    camera: string,
    image: number,
    { radar, scan }: ScanId,
    call?: Call,
  ): Promise<Table<object>> {
    const query = new URLSearchParams({ radar, scan: String(scan) });
    return this.table(`${inSequence(sequence)}/cameras/${part(camera)}/images/${image}/detections?${query}`, call);
  }

  /** The points of a LiDAR scan that lie in an image, the farthest first. */
  lidarInImage(
    sequence: string,
    camera: string,
    image: number,
    { name, scan }: { readonly name: string; readonly scan: number },
  ): Promise<Table<object>> {
    const query = new URLSearchParams({ lidar: name, scan: String(scan) });
    return this.table(`${inSequence(sequence)}/cameras/${part(camera)}/images/${image}/lidar?${query}`);
  }

  /** The detections of a thing that lie in an image. */
  thingInImage(sequence: string, camera: string, image: number, thing: number): Promise<Table<ThingInImageHeader>> {
    return this.table(`${inSequence(sequence)}/cameras/${part(camera)}/images/${image}/things/${thing}`);
  }

  moment(sequence: string, tNs: string, accumulate: number, call?: Call): Promise<ScansAround> {
    const query = new URLSearchParams({ t_ns: tNs, accumulate: String(accumulate), radars: "all" });
    return this.json("GET", `${inSequence(sequence)}/moment?${query}`, call);
  }

  stroke(sequence: string, stroke: StrokeRequest): Promise<StrokeAnswer> {
    return this.json("POST", `${inSequence(sequence)}/strokes`, undefined, stroke);
  }

  undo(sequence: string, id: string): Promise<StrokeAnswer> {
    return this.json("POST", `${inSequence(sequence)}/undo`, undefined, { id });
  }

  redo(sequence: string, id: string): Promise<StrokeAnswer> {
    return this.json("POST", `${inSequence(sequence)}/redo`, undefined, { id });
  }

  reviewed(sequence: string, { radar, scan }: ScanId, mark: MarkRequest): Promise<ReviewedAnswer> {
    const path = `${inSequence(sequence)}/radars/${part(radar)}/scans/${scan}/reviewed`;
    return this.json("PUT", path, undefined, mark);
  }

  /** What others change after `since`; `null`: at once, only how far the count is. */
  changes(sequence: string, since: number | null, call?: Call): Promise<Changes> {
    const path = `${inSequence(sequence)}/changes${since === null ? "" : `?since=${since}`}`;
    return this.json("GET", path, { signal: withPatience(call?.signal) });
  }

  private async table<Header>(path: string, call?: Call): Promise<Table<Header>> {
    const answer = await this.send("GET", path, call);
    return decodeTable<Header>(await received(answer.arrayBuffer()));
  }

  private async json<T>(method: string, path: string, call?: Call, body?: object): Promise<T> {
    const answer = await this.send(method, path, call, body);
    return (await received(answer.json())) as T;
  }

  private async send(method: string, path: string, call?: Call, body?: object): Promise<Response> {
    const headers = new Headers({ "X-Ralf-Tab": this.session.tab, "X-Ralf-Author": this.session.author });
    const name = this.session.name();
    if (name !== null) headers.set("X-Ralf-Name", encodeURIComponent(name));
    if (this.store !== null) headers.set("X-Ralf-Store", this.store);
    if (body !== undefined) headers.set("Content-Type", "application/json");
    // Whoever asks again after that asks for the same edit, which is made once.
    const signal = method === "GET" ? call?.signal : withPatience(call?.signal);
    const request: RequestInit = { method, headers, cache: "no-store", signal: signal ?? null };
    if (body !== undefined) request.body = JSON.stringify(body);
    const answer = await this.asked(path, request, headers);
    if (!answer.ok) throw await failure(answer);
    return answer;
  }

  /** The answer to one of the tokens, or else to the last. */
  private async asked(path: string, request: RequestInit, headers: Headers): Promise<Response> {
    const tokens = this.session.tokens();
    for (const [i, token] of tokens.entries()) {
      headers.set("Authorization", `Bearer ${token}`);
      const answer = await received(fetch(`/api/${path}`, request));
      if (answer.status === 401 && i + 1 < tokens.length) continue;
      // Of other corrections (412) it is the token of whoever serves those.
      if (![401, 412].includes(answer.status)) this.session.accepts(token);
      return answer;
    }
    return received(fetch(`/api/${path}`, request));
  }
}

/** Where nothing, or not all of it, came over the wire in time: the server is gone, unless the page itself gave up. */
async function received<T>(coming: Promise<T>): Promise<T> {
  return coming.catch((error: unknown) => {
    const late = error instanceof DOMException && error.name === "TimeoutError";
    throw late || error instanceof TypeError ? new ServerGone() : error;
  });
}

/** Gives up where the page does, and where no answer comes: a connection may end without a word. */
function withPatience(signal: AbortSignal | undefined): AbortSignal {
  const late = AbortSignal.timeout(PATIENCE_MS);
  return signal === undefined ? late : AbortSignal.any([signal, late]);
}

function part(name: string): string {
  return encodeURIComponent(name);
}

function inSequence(sequence: string): string {
  return `sequences/${part(sequence)}`;
}

async function failure(answer: Response): Promise<Error> {
  const body = (await answer.json().catch(() => null)) as Partial<ConflictBody> | null;
  const message = body?.error ?? `the server answered ${answer.status}`;
  if (answer.status === 401) return new TokenMissing();
  if (answer.status === 412) return new Elsewhere(message);
  if (answer.status !== 409) return new Refused(answer.status, message);
  const stale = body?.stale === true;
  return new Conflict({ error: message, conflict: body?.conflict ?? null, stale, scans: body?.scans ?? [] });
}
