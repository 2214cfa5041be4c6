/** One camera's image with the detections in it; can be zoomed, and the tools work on it. */

import type { CameraMoment } from "../data/camera-moment.js";
import { maskOf } from "../data/cloud.js";
import { h, say } from "../dom.js";
import { pointsIn } from "../history/outbox.js";
import type { Page } from "../page.js";
import { lookedAt } from "../state.js";
import type { Point } from "../selection/geometry.js";
import { Surface } from "../selection/surface.js";
import type { Gesture } from "../selection/tools.js";
import { cleared, drawBrushCursor, drawGesture, drawHover } from "../viewer/drawing.js";
import { drawDetections, LAYERS } from "./detections.js";
import { around, fitted, type Frame, movedBy, regionOf, toScreen, zoomedAt } from "./frame.js";
import { LidarLayer } from "./lidar-layer.js";

/** Narrower than this, px, an image would vanish behind the detections of other scans. */
const SMALL = 260;

export class CameraView {
  readonly element: HTMLElement;
  readonly surface: Surface;
  private readonly picture = h("canvas", { class: "scene" });
  private readonly overlay = h("canvas", { class: "overlay" });
  private readonly caption = h("span", { class: "caption" });
  private camera: CameraMoment | null = null;
  private frame: Frame = { scale: 1, left: 0, top: 0 };
  private touched = false;
  private gesture: Gesture | null = null;
  private pointer: Point | null = null;
  private places: Float32Array | null = null;
  private seen: Float32Array | null = null;
  private asked = 0;
  private readonly lidar = new LidarLayer();
  private aimed: Uint8Array | null = null;

  /** `watched`: what is drawn here counts as seen. */
  constructor(
    private readonly page: Page,
    private readonly watched = false,
  ) {
    this.element = h("div", { class: "camera" }, this.picture, this.overlay, this.caption);
    this.surface = new Surface(page.store, page.actions, {
      element: this.element,
      places: () => this.inSight(),
      showGesture: (gesture, pointer) => {
        [this.gesture, this.pointer] = [gesture, pointer];
        this.drawOverlay();
      },
      pan: (right, down) => this.look(movedBy(this.frame, right, down)),
    });
    this.element.addEventListener("contextmenu", (event) => event.preventDefault());
    this.element.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
    new ResizeObserver(() => this.fit()).observe(this.element);
    const { store } = page;
    store.watch(
      (state) => [
        state.painting,
        state.shown,
        state.eligible,
        state.selection,
        state.dotSize,
        state.waiting,
        state.lidarInImages,
        lookedAt(state),
      ],
      () => this.invalidate(),
    );
    store.watch(
      ({ hover, tool }) => [hover, tool],
      () => this.drawOverlay(),
    );
  }

  /** `aimed`: detections that the picture shows large, in place of the whole image. */
  show(camera: CameraMoment | null, aimed: Uint8Array | null = null): void {
    if (aimed !== this.aimed) this.touched = false;
    this.aimed = aimed;
    const other = camera?.info.name !== this.camera?.info.name;
    this.camera = camera;
    this.element.setAttribute("aria-label", camera === null ? "No camera" : `Camera ${camera.info.name}`);
    this.element.classList.toggle("failed", camera?.failed === true);
    say(this.caption, camera === null ? "" : captionOf(camera));
    if (other) this.fit();
    else this.invalidate();
  }

  /** Shows the whole image. */
  fit(): void {
    this.surface.cancel();
    this.touched = false;
    this.invalidate();
  }

  private invalidate(): void {
    [this.places, this.seen] = [null, null];
    if (this.asked !== 0) return;
    this.asked = requestAnimationFrame(() => {
      this.asked = 0;
      this.draw();
    });
  }

  private get size(): readonly [number, number] {
    return [this.element.clientWidth, this.element.clientHeight];
  }

  private zoom(event: WheelEvent): void {
    event.preventDefault();
    const box = this.element.getBoundingClientRect();
    const at: Point = [event.clientX - box.left, event.clientY - box.top];
    this.look(zoomedAt(this.frame, Math.exp(-event.deltaY * 0.0015), at));
  }

  private look(frame: Frame): void {
    this.surface.cancel();
    this.frame = frame;
    this.touched = true;
    this.invalidate();
  }

  private placed(): Float32Array {
    this.places ??= this.camera === null ? new Float32Array(0) : toScreen(this.frame, this.camera.places);
    return this.places;
  }

  /** The places of what can be seen: an image that is zoomed is larger than the element. */
  private inSight(): Float32Array {
    this.seen ??= within(this.placed(), ...this.size);
    return this.seen;
  }

  private draw(): void {
    const [width, height] = this.size;
    if (width === 0 || height === 0) return;
    const context = cleared(this.picture, width, height);
    const { camera } = this;
    if (context === null || camera === null) return;
    if (!this.touched) this.frame = this.untouched(camera, [width, height]);
    const { left, top, scale } = this.frame;
    if (camera.picture !== null) {
      context.imageSmoothingEnabled = scale < 3;
      context.drawImage(camera.picture, left, top, camera.info.width * scale, camera.info.height * scale);
    }
    this.drawLidar(context, camera, [width, height]);
    this.drawDots(context, width);
    if (this.watched) this.page.actions.review.saw(this.inSight());
    this.drawOverlay();
  }

  /** How an image lies there that nobody has moved. */
  private untouched({ info, places }: CameraMoment, size: readonly [number, number]): Frame {
    const region = this.aimed === null ? null : regionOf(places, this.aimed);
    return region === null ? fitted([info.width, info.height], size) : around(region, [info.width, info.height], size);
  }

  private drawLidar(
    context: CanvasRenderingContext2D,
    { lidar, info }: CameraMoment,
    size: readonly [number, number],
  ): void {
    const { lidarInImages, colour } = this.page.store.state;
    if (!lidarInImages || lidar === null) return;
    this.lidar.drawOn(
      context,
      lidar,
      [info.width, info.height],
      this.frame,
      size,
      colour === "height" ? "height" : "depth",
    );
  }

  private drawDots(context: CanvasRenderingContext2D, width: number): void {
    const { state } = this.page.store;
    const { cloud, painting, shown, selection, dotSize, sequence } = state;
    // Beside the thing that is looked at everything else is faint.
    const eligible = lookedAt(state) === null ? state.eligible : selection;
    const radius = dotSize * Math.min(0.5, Math.max(0.28, width / 1400));
    if (shown.length === cloud.count && painting.colours.length === 3 * cloud.count) {
      const waiting = maskOf(cloud, pointsIn(sequence, cloud.scans, state.waiting));
      drawDetections(
        context,
        this.placed(),
        { cloud, colours: painting.colours, shown, eligible, selection, waiting },
        radius,
        width < SMALL ? LAYERS.slice(1) : LAYERS,
      );
    }
  }

  private drawOverlay(): void {
    const [width, height] = this.size;
    const context = cleared(this.overlay, width, height);
    if (context === null) return;
    const { hover, tool, brush } = this.page.store.state;
    const places = this.placed();
    if (hover >= 0 && !Number.isNaN(places[2 * hover])) drawHover(context, places[2 * hover], places[2 * hover + 1], 8);
    if (this.gesture !== null) drawGesture(context, this.gesture, brush);
    else if (tool === "brush" && this.pointer !== null) drawBrushCursor(context, this.pointer, brush);
  }
}

/** The places that lie in the element; NaN for the others. */
function within(places: Float32Array, width: number, height: number): Float32Array {
  const inside = (at: number): boolean =>
    places[at] >= 0 && places[at] <= width && places[at + 1] >= 0 && places[at + 1] <= height;
  return places.map((value, i) => (inside(i - (i % 2)) ? value : Number.NaN));
}

function captionOf({ info, failed, problem }: CameraMoment): string {
  if (problem !== null) return `${info.name}: ${problem}`;
  return failed ? `${info.name} · failed` : info.name;
}
