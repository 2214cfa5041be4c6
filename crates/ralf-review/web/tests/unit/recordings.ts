/** Recordings made up for tests. */

import type { Recording, SequenceInfo } from "../../src/api/types.js";

export function sequence(name: string, assigned: string | null = null, labelled = true): SequenceInfo {
  return { name, title: "", labelled, assigned, radars: [], lidars: [], cameras: [] };
}

export function recordingOf(sequences: readonly SequenceInfo[], second: string | null = null): Recording {
  return {
    dataset: "city",
    out: "out",
    author: "ada",
    second,
    people: ["ada", "bob"],
    store: "hex",
    read_only: null,
    threshold: 0.5,
    sequences,
    classes: [],
    class_sources: ["", "lidar", "camera"],
    causes: null,
    sayable_causes: [""],
    flags: [],
  };
}
