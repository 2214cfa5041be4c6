/** What every action works with. */

import type { Api } from "../api/client.js";
import { messageOf } from "../api/errors.js";
import type { Session } from "../api/session.js";
import type { Loader } from "../data/loader.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export interface World {
  readonly store: Store<State>;
  readonly api: Api;
  readonly session: Session;
  readonly loader: Loader;
}

export function tell({ store }: World, text: string): void {
  store.set({ notice: { text, kind: "told" } });
}

export function complain({ store }: World, error: unknown): void {
  store.set({ notice: { text: messageOf(error), kind: "problem" } });
}

/** What went wrong before doesn't concern anybody any more. */
export function dismissProblem({ store }: World): void {
  if (store.state.notice?.kind === "problem") store.set({ notice: null });
}

/** Whether nothing can be corrected here, which is said. */
export function readOnly(world: World): boolean {
  const reason = world.store.state.recording.read_only;
  if (reason !== null) complain(world, `Read-only: nothing can be corrected here. ${reason}`);
  return reason !== null;
}
