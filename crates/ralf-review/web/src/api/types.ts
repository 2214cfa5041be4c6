/** What the server says: the types of docs/review-api.md. */

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
}

export interface Recording {
  readonly dataset: string;
  readonly out: string;
  readonly author: string;
  /** The plausibility from which a detection is labelled plausible. */
  readonly threshold: number;
  readonly sequences: readonly SequenceInfo[];
  readonly classes: readonly LabelClass[];
  readonly causes: readonly string[] | null;
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
  /** 0 to 1: how much the scan needs a person. */
  readonly need: number;
  readonly uncertain: number;
  readonly disagreeing: number;
  readonly cameras_failed: number;
  readonly corrected: number;
  readonly reviewed: Reviewed | null;
}

export interface Progress {
  readonly scans: number;
  readonly reviewed: number;
  readonly corrected_detections: number;
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
  readonly t_ns: string;
  readonly revision: number;
  readonly reviewed: Reviewed | null;
  /** Row-major 4 by 4, `null` where the recording has neither poses nor odometry. */
  readonly odom_from_vehicle: readonly number[] | null;
  readonly lidar: { readonly name: string; readonly scan: number } | null;
  readonly cameras: readonly CameraImageId[];
  readonly failed_cameras: readonly string[];
}

export interface LidarHeader {
  readonly t_ns: string;
  readonly odom_from_vehicle: readonly number[] | null;
}

export interface TimedScan extends ScanId {
  readonly t_ns: string;
}

export interface BaseRevision extends ScanId {
  readonly revision: number;
}

export interface ScanPoints extends ScanId {
  readonly points: readonly number[];
}

export interface StrokeRequest {
  readonly tool: string;
  readonly protect: boolean;
  /** `null`: back to the machine's guess. */
  readonly label: number | null;
  readonly base: readonly BaseRevision[];
  readonly points: readonly ScanPoints[];
  /** Strokes of one group are undone together. */
  readonly group?: string;
}

/** All corrections of a scan, as they are now. */
export interface ScanCorrections extends BaseRevision {
  readonly corrections: readonly (readonly [point: number, label: number])[];
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
  readonly conflict: ConflictCause | null;
  readonly scans: readonly ScanCorrections[];
}

export interface ReviewedAnswer {
  readonly reviewed: Reviewed | null;
  readonly progress: Progress;
}

export interface Changes {
  readonly counter: number;
  readonly scans: readonly (BaseRevision & { readonly author: string })[];
}
