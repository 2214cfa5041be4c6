/** What the server says: the types of docs/review-api.md. */

export type { Past, Saying, Workday } from "./people.js";

export interface SensorScans {
  readonly name: string;
  /** Times in nanoseconds, as strings for they exceed what a number holds. */
  readonly scans: readonly string[];
}

export interface CameraInfo {
  readonly name: string;
  readonly width: number;
  readonly height: number;
  readonly images: readonly string[];
}

export interface SequenceInfo {
  readonly name: string;
  readonly title: string;
  readonly labelled: boolean;
  /** Whose labels these are, where somebody has dealt them. */
  readonly assigned: string | null;
  readonly radars: readonly SensorScans[];
  readonly lidars: readonly SensorScans[];
  readonly cameras: readonly CameraInfo[];
}

export interface LabelClass {
  readonly id: number;
  readonly name: string;
  readonly cluster: string | null;
  readonly plausible: boolean | null;
}

export interface FlagInfo {
  readonly bit: number;
  readonly name: string;
  /** Where all such flags are set, the label is settled, whatever the branches say. */
  readonly decided: boolean;
}

export interface Recording {
  readonly dataset: string;
  readonly out: string;
  /** What people are called who give no name. */
  readonly author: string;
  /** Who labels a second time here, and sees nothing that others said. */
  readonly second: string | null;
  /** Who works on these labels, where somebody has said so. */
  readonly people: readonly string[];
  /** Of the corrections: another store has another one, and so has a copy of it. */
  readonly store: string;
  /** Why nothing can be corrected; `null` where it can. */
  readonly read_only: string | null;
  /** The plausibility from which a detection is labelled plausible. */
  readonly threshold: number;
  readonly sequences: readonly SequenceInfo[];
  readonly classes: readonly LabelClass[];
  /** What tells a class that the machine gave, by number; 0 is nothing. */
  readonly class_sources: readonly string[];
  readonly causes: readonly string[] | null;
  /** The causes that a stroke may say, by number; 0 is none. */
  readonly sayable_causes: readonly string[];
  readonly flags: readonly FlagInfo[];
}

export interface Reviewed {
  readonly author: string;
  readonly at: string;
}

export interface ScanId {
  readonly radar: string;
  readonly scan: number;
}

export interface QueueScan extends ScanId {
  readonly t_ns: string;
  readonly detections: number;
  /** How many of its labels are expected to be wrong, as far as nobody has said so yet. */
  readonly expected_errors: number;
  readonly uncertain: number;
  readonly disagreeing: number;
  readonly cameras_failed: number;
  readonly corrected: number;
  readonly reviewed: Reviewed | null;
  /** Corrections and marks of other detections than the scan has now; kept, and never applied. */
  readonly orphaned: number;
}

/** Detections that belong together in the world, of which some are expected to be labelled wrongly. */
export interface DoubtfulThing extends ScanId {
  readonly thing: number;
  /** The middle in the odometry frame, m. */
  readonly place: readonly [x: number | null, y: number | null, z: number | null];
  readonly radius: number | null;
  readonly detections: number;
  readonly scans: number;
  /** How many the machine calls plausible. */
  readonly plausible: number;
  readonly answered: number;
  readonly expected_errors: number;
  /** A detection of it, in the scan that the id names. */
  readonly point: number;
}

export interface Doubtful {
  /** The run that the things are of. */
  readonly run: string;
  /** Those with the most expected errors first. */
  readonly doubtful: readonly DoubtfulThing[];
  readonly things: number;
  readonly expected_errors: number;
}

/** A thing that would be called otherwise, after what people said of others. */
export interface ProposedChange extends DoubtfulThing {
  /** What it would be, as a label id, and how probable that is. */
  readonly label: number;
  readonly probability: number;
  /** The detections that this would change, wherever they are. */
  readonly points: readonly ScanPoints[];
}

/** What the labels would be, after what people said of some of them. */
export interface Opinion {
  /** How many detections people said something of. */
  readonly answered: number;
  /** Those of the most detections first. */
  readonly changes: readonly ProposedChange[];
  /** How many scans were learned from and looked at, of all that have detections; `null` where nobody said anything. */
  readonly scans: { readonly looked_at: number; readonly all: number } | null;
  /** Of every scan that would change. */
  readonly base: readonly BaseRevision[];
}

/**
 * Detections of a thing to which two people, neither of whom saw the other's, gave different labels, or of which both
 * said why they are artifacts, and not the same.
 */
export interface Disagreement extends DoubtfulThing {
  readonly first: number;
  readonly second: number;
  /** Why they are artifacts, where that was said, too. */
  readonly first_cause: string | null;
  readonly second_cause: string | null;
  /** Who labelled them a second time. */
  readonly by: string;
  readonly points: readonly ScanPoints[];
}

export interface Agreed {
  readonly labelled_by_both: number;
  readonly disagree: number;
  /** Cohen's; `null` where chance alone would have both always agree. */
  readonly kappa: number | null;
}

/** How far two people agree in the scans that both are through with. */
export interface Agreement {
  readonly second: string;
  readonly scans: number;
  /** Scans that the second is through with and that were not dealt to this person: they don't count. */
  readonly left_out: number;
  readonly agreement: {
    readonly overall: Agreed;
    readonly radars: Readonly<Record<string, Agreed>>;
    /** By the label's name: how often both gave it, and each alone. */
    readonly classes: Readonly<
      Record<string, { both: number; first_alone: number; second_alone: number; kappa: number | null }>
    >;
  };
}

export interface Disagreements {
  readonly people: readonly Agreement[];
  /** Scans that are to be labelled twice and aren't yet; `null` where nobody has dealt any. */
  readonly waiting: number | null;
  /** Those about plausibility first, and of these the largest. */
  readonly changes: readonly Disagreement[];
  readonly base: readonly BaseRevision[];
}

export interface ThingsHeader extends Doubtful {
  readonly scans: readonly (ScanId & { readonly rows: number })[];
}

export interface Progress {
  readonly scans: number;
  readonly reviewed: number;
  readonly corrected_detections: number;
  readonly orphaned_scans: number;
}

export interface Queue {
  readonly scans: readonly QueueScan[];
  readonly progress: Progress;
}

export interface CameraImageId {
  readonly name: string;
  readonly image: number;
  readonly t_ns: string;
}

export interface ScanHeader {
  /** The run that labelled it: another one once somebody labels again. */
  readonly run: string;
  readonly t_ns: string;
  /** Of the detections: a scan with others has another one. */
  readonly content: string;
  /** Of the machine's labels: whoever accepts them names it. */
  readonly stamp: string;
  readonly revision: number;
  readonly reviewed: Reviewed | null;
  /** Row-major 4 by 4, `null` where the recording has neither poses nor odometry. */
  readonly odom_from_vehicle: readonly number[] | null;
  /** Where the radar is in the vehicle frame, m. */
  readonly origin: readonly [x: number, y: number, z: number];
  readonly lidar: { readonly name: string; readonly scan: number } | null;
  readonly cameras: readonly CameraImageId[];
  readonly failed_cameras: readonly string[];
  /** Where a model was asked: the names of causes by their numbers in the column `machine_cause`; 0 is none. */
  readonly machine_causes?: readonly string[];
}

export interface LidarHeader {
  readonly t_ns: string;
  readonly odom_from_vehicle: readonly number[] | null;
}

/** Which scans the detections of a thing that lie in an image are of. */
export interface ThingInImageHeader {
  readonly scans: readonly ScanId[];
}

export interface TimedScan extends ScanId {
  readonly t_ns: string;
}

/** Which scans belong on the screen, and the run whose labels theirs are now. */
export interface ScansAround {
  readonly run: string;
  readonly scans: readonly TimedScan[];
}

export interface BaseRevision extends ScanId {
  readonly revision: number;
  /** The detections that were on screen. */
  readonly content?: string;
}

export interface ScanPoints extends ScanId {
  readonly points: readonly number[];
}

export interface StrokeRequest {
  /** One that is asked for again is made once. */
  readonly id: string;
  readonly tool: string;
  readonly protect: boolean;
  /** Detections that have the label already are noted, too. */
  readonly confirm?: boolean;
  /** `null`: back to the machine's guess. */
  readonly label: number | null;
  /** Why it is an artifact. */
  readonly cause?: string;
  readonly base: readonly BaseRevision[];
  readonly points: readonly ScanPoints[];
  /** Strokes of one group are undone together. */
  readonly group?: string;
}

export interface MarkRequest {
  readonly id: string;
  readonly reviewed: boolean;
  readonly revision: number;
  /** Of the labels on screen. */
  readonly stamp: string;
}

/** All that is said of a scan, as it is now. */
export interface ScanCorrections extends ScanId {
  readonly revision: number;
  readonly reviewed: Reviewed | null;
  readonly corrections: readonly (readonly [point: number, label: number])[];
  readonly causes: readonly (readonly [point: number, cause: number])[];
}

export interface PastStroke {
  readonly tool: string;
  readonly label: number | null;
  readonly changed: number;
  readonly at: string;
}

export interface History {
  readonly undo: PastStroke | null;
  readonly redo: PastStroke | null;
  readonly undo_depth: number;
  readonly redo_depth: number;
}

export interface StrokeAnswer {
  readonly changed: number;
  readonly scans: readonly ScanCorrections[];
  readonly history: History;
}

export interface ConflictCause extends ScanId {
  readonly author: string;
  readonly at: string;
  readonly tool: string;
}

export interface ConflictBody {
  readonly error: string;
  /** True where the detections or labels on screen are not those that lie there now. */
  readonly stale: boolean;
  readonly conflict: ConflictCause | null;
  readonly scans: readonly ScanCorrections[];
}

export interface ReviewedAnswer extends StrokeAnswer {
  readonly reviewed: Reviewed | null;
  readonly progress: Progress;
}

export interface Changes {
  readonly counter: number;
  readonly scans: readonly (ScanId & { readonly revision: number; readonly author: string })[];
}
