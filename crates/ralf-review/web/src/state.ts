/** Everything the page knows and shows. */

import type {
  Disagreement,
  Disagreements,
  DoubtfulThing,
  History,
  Opinion,
  Past,
  Progress,
  QueueScan,
  Recording,
  ScanId,
  Workday,
} from "./api/types.js";
import type { Link } from "./api/errors.js";
import type { Kind } from "./api/kinds.js";
import type { AreaKind, Home } from "./data/area.js";
import type { CameraMoment } from "./data/camera-moment.js";
import { buildCloud, type Cloud } from "./data/cloud.js";
import { everything, type Filter } from "./data/filter.js";
import { type Choice, LabelBook } from "./data/labels.js";
import type { ReplayPart } from "./data/replay.js";
import type { Rule, Verdict } from "./data/rules.js";
import { sameScan } from "./data/scan.js";
import type { Lidar } from "./data/lidar.js";
import type { Unseen } from "./data/sight.js";
import type { OutboxStatus, Pending } from "./history/outbox.js";
import type { QueueView } from "./queue/queue.js";
import type { Tool } from "./selection/tools.js";
import type { ColourMode, Painting } from "./viewer/colours.js";

/** The most scans before and after the current one that are on screen: as many as the server tells of at once. */
export const MOST_ACCUMULATED = 100;

export type ViewMode = "bird" | "free" | "camera";
/** What a stroke may change: the scan under review alone, or everything shown. */
export type Scope = "scan" | "shown";
export type Dialog = "none" | "help" | "classes" | "name" | "team" | "replay";
export type Drawer = "none" | "scans" | "numbers";

/** Detections that would be accepted unseen; a second time accepts them. */
export interface Accepting extends Unseen {
  readonly goOn: boolean;
}

/** What a rule would change in sequence after sequence. */
export interface Replay {
  readonly name: string;
  readonly sets: Verdict;
  /** Those that were read, of so many. */
  readonly parts: readonly ReplayPart[];
  readonly all: number;
}

export interface Notice {
  readonly text: string;
  readonly kind: "told" | "problem";
}

/** A place that the picture is to show: x, y, m, vehicle frame, and how many metres around it. */
export interface Focus {
  readonly x: number;
  readonly y: number;
  readonly span: number;
}

export interface State {
  readonly recording: Recording;
  readonly labels: LabelBook;
  /** What the person in this browser is called. */
  readonly name: string;
  readonly sequence: string;
  readonly scans: readonly QueueScan[];
  readonly progress: Progress;
  /** Of other sequences, as far as somebody asked. */
  readonly progressElsewhere: ReadonlyMap<string, Progress>;
  readonly queueView: QueueView;

  /** The thing that wants an answer, while somebody goes from thing to thing. */
  readonly thing: DoubtfulThing | null;
  readonly focus: Focus | null;
  /** What would change by what was said, until somebody accepts or drops it. */
  readonly opinion: Opinion | null;
  /** The place of the change that is looked at, or -1. */
  readonly opinionAt: number;
  /** True while the server thinks it over. */
  readonly thinking: boolean;

  /** How far people agree in this sequence; `null` until somebody asks. */
  readonly disagreements: Disagreements | null;
  /** What two people said differently, while it is looked at. */
  readonly disputed: Disagreement | null;
  /** Who has done how much, as far as somebody asked. */
  readonly workdays: readonly Workday[];
  /** What was said of the chosen detection, or of the thing. */
  readonly past: Past | null;

  /** The scan under review. */
  readonly current: ScanId | null;
  readonly loading: boolean;
  readonly cloud: Cloud;
  readonly lidar: Lidar | null;
  /** The LiDAR's points around what is held still; `null` where nothing is, or they have not come. */
  readonly heldLidar: Lidar | null;
  readonly cameras: readonly CameraMoment[];

  readonly mode: ViewMode;
  readonly colour: ColourMode;
  readonly accumulate: number;
  readonly lidarShown: boolean;
  readonly groundHidden: boolean;
  /** The LiDAR's points are drawn into the cameras' images. */
  readonly lidarInImages: boolean;
  /** A light background in the picture. */
  readonly light: boolean;
  /** Diameter of a detection, px. */
  readonly dotSize: number;
  readonly filter: Filter;
  /** Filters that were kept under a name. */
  readonly rules: readonly Rule[];
  /** The many detections that a question is asked about, or `null`. */
  readonly kind: Kind | null;
  /** The rule whose selection is looked at, until it is applied or dropped. */
  readonly rule: Rule | null;
  /** What a rule would change in all sequences, while that is looked at. */
  readonly replay: Replay | null;
  /** The camera a person chose to see large; `null`: the one that sees most. */
  readonly chosenCamera: string | null;

  /** 1 for each detection that the filter lets through, and that a stroke may change. */
  readonly shown: Uint8Array;
  readonly eligible: Uint8Array;
  readonly painting: Painting;

  readonly tool: Tool;
  /** What the next stroke in the scene adds to the filter; `null`: strokes choose detections. */
  readonly drawing: AreaKind | null;
  /** Radius of the brush, px. */
  readonly brush: number;
  readonly scope: Scope;
  readonly protect: boolean;
  /** What every stroke sets at once; `undefined`: strokes only select. */
  readonly armed: Choice | undefined;
  readonly selection: Uint8Array;
  readonly hover: number;
  /** The detection that was chosen by keyboard last, or -1. */
  readonly picked: number;
  /** For those who don't see the picture. */
  readonly announced: string;
  /** Not `null`: a mark waits for a second press. */
  readonly accepting: Accepting | null;
  /** x, y under the pointer, m, vehicle frame. */
  readonly cursor: readonly [number, number] | null;

  readonly history: History;
  readonly outbox: OutboxStatus;
  readonly waiting: readonly Pending[];
  readonly link: Link;
  /** True while an undo, redo or mark is under way. */
  readonly busy: boolean;
  readonly notice: Notice | null;
  readonly dialog: Dialog;
  /** What is laid over the picture where the window has no room for it beside. */
  readonly drawer: Drawer;
  /** From the change until the picture was drawn, ms: the graphics card's work is part of it. */
  readonly frameTime: number;
}

const NO_HISTORY: History = { undo: null, redo: null, undo_depth: 0, redo_depth: 0 };

/** What a person does, before anything is done. */
const NOTHING_DONE = {
  tool: "click",
  drawing: null,
  brush: 18,
  scope: "scan",
  protect: true,
  armed: undefined,
  selection: new Uint8Array(0),
  hover: -1,
  picked: -1,
  announced: "",
  accepting: null,
  cursor: null,
  history: NO_HISTORY,
  outbox: { kind: "idle" },
  waiting: [],
  link: { kind: "fine" },
  busy: false,
  notice: null,
  dialog: "none",
  drawer: "none",
  frameTime: 0,
} as const satisfies Partial<State>;

/** One is looked at at a time: what begins drops the rest. */
export const NOTHING_LOOKED_AT = {
  thing: null,
  opinion: null,
  opinionAt: -1,
  rule: null,
  kind: null,
  disputed: null,
} as const satisfies Partial<State>;

/** Nothing is looked at and nothing selected: until what comes is on screen, no key says anything of what was. */
export function nothingChosen({ cloud }: Readonly<State>): typeof NOTHING_LOOKED_AT & Pick<State, "selection"> {
  return { ...NOTHING_LOOKED_AT, selection: new Uint8Array(cloud.count) };
}

/** The thing that is looked at: it wants an answer, two people labelled it differently, or it would change. */
export function lookedAt({ thing, disputed, opinion, opinionAt }: Readonly<State>): DoubtfulThing | null {
  return thing ?? disputed ?? opinion?.changes[opinionAt] ?? null;
}

/** Whether a scan is the one under review, and there: one that was asked for may still be on its way. */
export function isOnScreen({ cloud, loading }: Readonly<State>, id: ScanId): boolean {
  return !loading && sameScan(cloud.scans.at(0) ?? null, id);
}

/** Whose places are on screen. */
export function homeOf({ recording, sequence }: Readonly<State>): Home {
  return { dataset: recording.dataset, sequence };
}

export function initialState(recording: Recording, name: string): State {
  return {
    ...NOTHING_DONE,
    ...NOTHING_LOOKED_AT,
    recording,
    labels: new LabelBook(recording.classes),
    name,
    sequence: "",
    scans: [],
    progress: { scans: 0, reviewed: 0, corrected_detections: 0, orphaned_scans: 0 },
    progressElsewhere: new Map(),
    queueView: { order: "need", hideReviewed: false, radar: null },
    focus: null,
    thinking: false,
    disagreements: null,
    workdays: [],
    past: null,
    current: null,
    loading: true,
    cloud: buildCloud([]),
    lidar: null,
    heldLidar: null,
    cameras: [],
    mode: "bird",
    colour: "label",
    accumulate: 0,
    lidarShown: true,
    groundHidden: true,
    lidarInImages: false,
    light: false,
    dotSize: 8,
    filter: everything,
    rules: [],
    replay: null,
    chosenCamera: null,
    shown: new Uint8Array(0),
    eligible: new Uint8Array(0),
    painting: { colours: new Uint8Array(0), legend: { kind: "categories", entries: [] } },
  };
}
