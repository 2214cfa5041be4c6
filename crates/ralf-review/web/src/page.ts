/** What every view gets: the state to watch, and what can be done. */

import type { Actions } from "./actions/actions.js";
import type { State } from "./state.js";
import type { Store } from "./store.js";

export interface Page {
  readonly store: Store<State>;
  readonly actions: Actions;
}
