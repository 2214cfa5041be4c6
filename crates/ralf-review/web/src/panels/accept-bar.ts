/** Before detections are accepted that were never on screen: how many, and what can be done. */

import { h, say } from "../dom.js";
import { counted } from "../format.js";
import type { Page } from "../page.js";
import type { Accepting } from "../state.js";
import { keyButton } from "./buttons.js";

export function acceptBar({ store, actions }: Page, show: () => void): HTMLElement {
  const text = h("span", { class: "accept-text" });
  const look = keyButton("Show them", "F", show);
  const goOn = (): void => actions.review.accept(store.state.accepting?.goOn === true);
  const accept = keyButton("Accept them", "Enter", goOn, "quiet");
  const bar = h("div", { class: "accept", role: "alert" }, text, look, accept);
  store.watch(
    ({ accepting }) => [accepting],
    (accepting) => {
      bar.hidden = accepting === null;
      say(text, accepting === null ? "" : question(accepting));
    },
  );
  return bar;
}

function question({ all, hidden }: Accepting): string {
  const where =
    hidden === 0 ? "" : hidden === all ? " (the filter hides them)" : ` (the filter hides ${hidden} of them)`;
  const were = all === 1 ? "was" : "were";
  const which = `${counted(all, "detection")} of this scan ${were} not on screen yet${where}`;
  return `${which}. Enter again accepts them unseen.`;
}
