/** Where a person begins: the sequence of whoever labels it, or one in which somebody labels a second time. */

import type { Progress, Recording } from "../api/types.js";
import type { Dialog, State } from "../state.js";
import type { Store } from "../store.js";
import { type Address, addressFrom } from "./address.js";

/** What the address asks for, else the first sequence with something to do for this person; `null`: there is none. */
export async function firstAddress(
  recording: Recording,
  person: string,
  hash: string,
  progress: (sequence: string) => Promise<Progress>,
): Promise<Address | null> {
  const { sequences, second } = recording;
  const asked = addressFrom(hash);
  if (asked !== null && sequences.some(({ name }) => name === asked.sequence)) return asked;
  const labelled = sequences.filter((one) => one.labelled);
  const own = labelled.find(({ assigned }) => assigned === person);
  const dealt = second === null ? own?.name : await firstQueued(labelled, progress);
  const name = dealt ?? labelled[0]?.name ?? sequences[0]?.name;
  return name === undefined ? null : { sequence: name, scan: null };
}

/** The first sequence with scans that still want a person, else the first with any: second labels are of few scans. */
async function firstQueued(
  labelled: Recording["sequences"],
  progress: (sequence: string) => Promise<Progress>,
): Promise<string | undefined> {
  let done: string | undefined;
  for (const { name } of labelled) {
    // What can't be read is told of by whoever opens it; the others may still be labelled.
    const { scans, reviewed } = await progress(name).catch(() => ({ scans: 0, reviewed: 0 }));
    if (reviewed < scans) return name;
    if (scans > 0) done ??= name;
  }
  return done;
}

/** Resolves once the dialog is closed, by an answer or without one. */
export function closed(store: Store<State>, dialog: Dialog): Promise<void> {
  return new Promise((resolve) => {
    if (store.state.dialog !== dialog) return resolve();
    const end = store.watch(
      ({ dialog: now }) => [now],
      (now) => {
        if (now === dialog) return;
        end();
        resolve();
      },
    );
  });
}

/** A person's name as others have it: names that differ by case alone are one person's. */
export function nameAmong(people: readonly string[], name: string): string {
  return people.find((known) => known.toLowerCase() === name.toLowerCase()) ?? name;
}
