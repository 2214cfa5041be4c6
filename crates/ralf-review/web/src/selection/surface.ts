/** Lets the tools work on a picture: the bird's eye, the free view, or a camera's image. */

import type { Actions } from "../actions/actions.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";
import { collect, nearest, type Point } from "./geometry.js";
import type { Combination } from "./mask.js";
import { begun, type Gesture, isPress, moved, pressedAgain, shapeOf } from "./tools.js";

export interface Picture {
  /** Gets the pointer's events; its upper left corner is the origin of pixels. */
  readonly element: HTMLElement;
  /** x, y of every detection in CSS pixels, NaN where it isn't seen. */
  places(): Float32Array;
  /** Shows the gesture, and the brush where the pointer is. */
  showGesture(gesture: Gesture | null, pointer: Point | null): void;
  /** Where on the plane a pixel lies, x, y, m; only of pictures that show the plane. */
  groundAt?(at: Point): Point | null;
  /** Moves the picture by so many pixels. */
  pan(right: number, down: number): void;
}

/** How near a detection must be to a press, px. */
const REACH = 12;

export class Surface {
  private gesture: Gesture | null = null;
  private panning: Point | null = null;
  private dragged = false;

  constructor(
    private readonly store: Store<State>,
    private readonly actions: Actions,
    private readonly picture: Picture,
  ) {
    const { element } = picture;
    element.addEventListener("pointerdown", (event) => this.press(event));
    element.addEventListener("pointermove", (event) => this.move(event));
    element.addEventListener("pointerup", (event) => this.release(event));
    element.addEventListener("pointerleave", () => this.leave());
    element.addEventListener("dblclick", (event) => this.closePolygon(combination(event)));
    element.addEventListener("pointercancel", () => this.giveUp());
    // What was drawn was drawn on another picture.
    store.watch(
      ({ tool, cloud, mode }) => [tool, cloud.positions, mode],
      () => this.cancel(),
    );
  }

  /** Gives an unfinished gesture up; false where there is none. */
  cancel(): boolean {
    if (this.gesture === null) return false;
    this.gesture = null;
    this.picture.showGesture(null, null);
    return true;
  }

  /** Ends a polygon that has corners enough. */
  closePolygon(how: Combination): boolean {
    if (this.gesture?.tool !== "polygon") return false;
    this.finish(how);
    return true;
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    const at = this.pixel(event);
    const { tool } = this.store.state;
    this.picture.element.setPointerCapture(event.pointerId);
    this.dragged = false;
    if (isPress(tool)) this.panning = at;
    else if (tool === "polygon" && this.gesture !== null) this.addCorner(at, event);
    else this.show(begun(tool, at), at);
  }

  private addCorner(at: Point, event: PointerEvent): void {
    if (this.gesture === null) return;
    const { gesture, closed } = pressedAgain(this.gesture, at);
    if (closed) this.finish(combination(event));
    else this.show(gesture, at);
  }

  private move(event: PointerEvent): void {
    const at = this.pixel(event);
    if (this.panning !== null) return this.drag(at);
    if (this.gesture !== null) return this.show(this.along(event).reduce(moved, this.gesture), at);
    if (event.buttons === 0) this.hover(at);
    this.picture.showGesture(null, at);
  }

  /** Where the pointer was since the last picture: with a slow one a lasso would cut its corners. */
  private along(event: PointerEvent): readonly Point[] {
    const all = event.getCoalescedEvents();
    return (all.length > 0 ? all : [event]).map((one) => this.pixel(one));
  }

  private drag(at: Point): void {
    if (this.panning === null) return;
    const [right, down] = [at[0] - this.panning[0], at[1] - this.panning[1]];
    if (!this.dragged && Math.hypot(right, down) < 4) return;
    this.dragged = true;
    this.picture.pan(right, down);
    this.panning = at;
  }

  private release(event: PointerEvent): void {
    if (event.button !== 0) return;
    const pressed = this.panning;
    this.panning = null;
    if (pressed !== null && !this.dragged) this.choose(pressed, combination(event));
    if (this.gesture !== null && this.gesture.tool !== "polygon") this.finish(combination(event));
  }

  /** The pointer was taken away, by the system or by a second finger. */
  private giveUp(): void {
    this.panning = null;
    this.cancel();
  }

  private leave(): void {
    this.actions.select.hover(-1);
    if (this.gesture === null) this.picture.showGesture(null, null);
  }

  private hover(at: Point): void {
    const { eligible, shown } = this.store.state;
    const places = this.picture.places();
    const own = nearest(places, eligible, at, REACH);
    this.actions.select.hover(own >= 0 ? own : nearest(places, shown, at, REACH));
  }

  private choose(at: Point, how: Combination): void {
    const { eligible, tool } = this.store.state;
    const found = nearest(this.picture.places(), eligible, at, REACH);
    const mask = new Uint8Array(eligible.length);
    if (found >= 0) mask[found] = 1;
    this.actions.select.gesture(isPress(tool) ? tool : "click", mask, how);
  }

  private finish(how: Combination): void {
    const { brush, eligible } = this.store.state;
    const shape = this.gesture === null ? null : shapeOf(this.gesture, brush);
    const tool = this.gesture?.tool ?? "click";
    const path = this.gesture?.path ?? [];
    this.cancel();
    if (this.store.state.drawing !== null) return this.draw(path);
    if (shape === null) return;
    const mask = new Uint8Array(eligible.length);
    collect(shape, this.picture.places(), eligible, mask);
    this.actions.select.gesture(tool, mask, how);
  }

  /** A stroke that says where, and chooses nothing. */
  private draw(path: readonly Point[]): void {
    const places = path.map((at) => this.picture.groundAt?.(at) ?? null).filter((at) => at !== null);
    this.actions.view.drew(places);
  }

  private show(gesture: Gesture, pointer: Point): void {
    this.gesture = gesture;
    this.picture.showGesture(gesture, pointer);
  }

  private pixel(event: MouseEvent): Point {
    const box = this.picture.element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
}

function combination(event: MouseEvent): Combination {
  if (event.altKey || event.ctrlKey || event.metaKey) return "remove";
  return event.shiftKey ? "add" : "replace";
}
