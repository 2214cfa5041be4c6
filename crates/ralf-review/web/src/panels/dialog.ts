/** What all dialogs have in common. */

import type { Page } from "../page.js";
import type { Dialog } from "../state.js";

/** Opens and closes a dialog as the state says; Escape and a press outside close it. */
export function openWith(
  { store, actions }: Page,
  dialog: HTMLDialogElement,
  name: Dialog,
  opened: () => void = () => undefined,
): void {
  const close = (): void => {
    if (store.state.dialog === name) actions.view.dialog("none");
  };
  dialog.addEventListener("cancel", close);
  dialog.addEventListener("close", close);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) close();
  });
  store.watch(
    ({ dialog: now }) => [now],
    (now) => {
      if (now === name && !dialog.open) {
        dialog.showModal();
        opened();
      } else if (now !== name && dialog.open) {
        dialog.close();
      }
    },
  );
}
