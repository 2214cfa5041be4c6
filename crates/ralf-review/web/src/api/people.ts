/** What people said and did: types of docs/review-api.md. */

/** What one person did on one day. */
export interface Workday {
  readonly author: string;
  readonly second: boolean;
  readonly day: string;
  readonly edits: number;
  readonly detections: number;
  readonly scans: number;
  readonly worked_s: number;
}

/** What somebody said once. */
export interface Saying {
  readonly author: string;
  readonly at: string;
  readonly tool: string;
  readonly label: number | null;
  readonly cause: string | null;
  /** Of how many of the detections that were asked about. */
  readonly detections: number;
  /** False where it was taken back. */
  readonly holds: boolean;
}

/** What was ever said of a detection or a thing, the last first. */
export interface Past {
  readonly detections: number;
  readonly said: readonly Saying[];
}
