/** Wheel, right and middle button move the view; the left button belongs to the tools. */

import { panned, type Rig, turned, zoomed } from "./rig.js";

export interface Navigable {
  readonly rig: Rig;
  readonly size: readonly [number, number];
  groundAt(x: number, y: number): readonly [number, number] | null;
}

const MIDDLE = 1;
const RIGHT = 2;

export function navigate(element: HTMLElement, view: Navigable, above: () => boolean, aim: (rig: Rig) => void): void {
  let last: readonly [number, number] | null = null;
  let turning = false;
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const anchor = view.groundAt(...pixel(element, event));
      // Over the horizon, or far away, zooming towards the pointer would fling the view away.
      const near =
        anchor !== null &&
        Math.hypot(anchor[0] - view.rig.target[0], anchor[1] - view.rig.target[1]) < 2 * view.rig.span;
      aim(zoomed(view.rig, Math.exp(event.deltaY * 0.0012), near ? anchor : null));
    },
    { passive: false },
  );
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== MIDDLE && event.button !== RIGHT) return;
    event.preventDefault();
    element.setPointerCapture(event.pointerId);
    turning = event.button === RIGHT && !above() && !event.shiftKey;
    last = [event.clientX, event.clientY];
  });
  element.addEventListener("pointermove", (event) => {
    if (last === null) return;
    const [right, down] = [event.clientX - last[0], event.clientY - last[1]];
    last = [event.clientX, event.clientY];
    aim(turning ? turned(view.rig, right, down) : panned(view.rig, right, down, view.size[1], above()));
  });
  element.addEventListener("pointerup", () => {
    last = null;
  });
}

function pixel(element: HTMLElement, event: MouseEvent): readonly [number, number] {
  const box = element.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}
