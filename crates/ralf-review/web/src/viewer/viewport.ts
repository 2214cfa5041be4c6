/** The centre of the page: the WebGL picture, what is drawn over it, and the pointer on it. */

import { cornersHere, liesIn } from "../data/area.js";
import { maskOf } from "../data/cloud.js";
import { h } from "../dom.js";
import { pointsIn } from "../history/outbox.js";
import type { Page } from "../page.js";
import { homeOf } from "../state.js";
import type { Point } from "../selection/geometry.js";
import { Surface } from "../selection/surface.js";
import type { Gesture } from "../selection/tools.js";
import { cleared, drawAreas, drawBrushCursor, drawGesture, drawHover } from "./drawing.js";
import { certaintyOf } from "../data/filter.js";
import { marksOf, nearOf } from "./marks.js";
import { navigate } from "./navigate.js";
import { around, panned, type Rig } from "./rig.js";
import { drawAxes, drawRingLabels, drawScaleBar } from "./scale.js";
import { SceneView } from "./scene.js";

export class Viewport {
  readonly element: HTMLElement;
  readonly surface: Surface;
  private readonly view: SceneView;
  private readonly overlay = h("canvas", { class: "overlay" });
  private gesture: Gesture | null = null;
  private pointer: Point | null = null;
  private places: Float32Array | null = null;

  constructor(private readonly page: Page) {
    const canvas = h("canvas", { class: "scene", "aria-label": "Radar detections over LiDAR" });
    this.element = h(
      "div",
      { class: "viewport", tabindex: "0", "aria-label": "Bird's eye and free view" },
      canvas,
      this.overlay,
    );
    this.view = new SceneView(
      canvas,
      () => this.drawOverlay(),
      (milliseconds) => page.actions.view.drawn(milliseconds),
      () => page.actions.view.gone(),
    );
    this.surface = new Surface(page.store, page.actions, {
      element: this.element,
      places: () => this.placed(),
      showGesture: (gesture, pointer) => {
        [this.gesture, this.pointer] = [gesture, pointer];
        this.tellCursor();
        this.drawOverlay();
      },
      groundAt: (at) => this.view.groundAt(...at),
      pan: (right, down) => this.aim(panned(this.view.rig, right, down, this.view.size[1], this.above)),
    });
    navigate(
      this.element,
      this.view,
      () => this.above,
      (rig) => this.aim(rig),
    );
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.watchScene();
    this.watchLooks();
  }

  /** Shows the whole scan. */
  home(): void {
    const { cloud } = this.page.store.state;
    const rows = cloud.scans[0]?.table.rows ?? 0;
    this.aim(around(cloud.positions.subarray(0, 3 * rows), this.view.size));
  }

  private get above(): boolean {
    return this.page.store.state.mode !== "free";
  }

  /** What is in the scene. */
  private watchScene(): void {
    const { store } = this.page;
    const { view } = this;
    store.watch(
      ({ cloud }) => [cloud.positions],
      (positions) => {
        view.radar.setPositions(positions);
        this.changed();
      },
    );
    store.watch(
      ({ lidar, heldLidar, cloud }) => [cloud.held ? heldLidar : lidar],
      (lidar) => {
        view.lidar.set(lidar);
        this.element.dataset["lidarPoints"] = String(lidar?.count ?? 0);
      },
    );
    store.watch(
      ({ painting }) => [painting],
      ({ colours }) => {
        view.radar.setColours(colours);
        this.changed();
      },
    );
    store.watch(
      (state) => [state.cloud, state.shown, nearOf(state), state.selection, state.waiting, state.recording],
      (cloud, shown, near, selection, strokes, recording) => {
        if (shown.length !== cloud.count || selection.length !== cloud.count) return;
        const waiting = maskOf(cloud, pointsIn(store.state.sequence, cloud.scans, strokes));
        view.radar.setMarks(marksOf(cloud, { shown, near, selection, waiting }, certaintyOf(recording)));
        this.changed();
      },
    );
  }

  /** How the scene is looked at, and what lies over it. */
  private watchLooks(): void {
    const { store } = this.page;
    const { view } = this;
    store.watch(
      ({ lidarShown, groundHidden, dotSize, mode, lidar, heldLidar, cloud }) => [
        lidarShown,
        groundHidden,
        dotSize,
        mode,
        cloud.held ? heldLidar : lidar,
      ],
      (lidarShown, groundHidden, dotSize) => {
        view.lidar.setLook(lidarShown, groundHidden, view.pixelRatio);
        view.radar.setSize(dotSize * view.pixelRatio);
        view.setBird(this.above);
        this.changed();
      },
    );
    store.watch(
      ({ hover, tool, filter }) => [hover, tool, filter.areas],
      () => this.drawOverlay(),
    );
    store.watch(
      ({ focus }) => [focus],
      (focus) => {
        if (focus === null) return;
        const { rig } = this.view;
        this.aim({ ...rig, target: [focus.x, focus.y, rig.target[2]], span: focus.span });
      },
    );
    store.watch(
      ({ light }) => [light],
      (light) => view.setLight(light),
    );
    store.watch(
      ({ picked, announced }) => [picked, announced],
      (picked) => this.bringIntoView(picked),
    );
  }

  /** Moves the picture so that a detection is in it. */
  private bringIntoView(index: number): void {
    const { positions, count } = this.page.store.state.cloud;
    if (index < 0 || index >= count || !Number.isNaN(this.placed()[2 * index])) return;
    const { rig } = this.view;
    this.aim({ ...rig, target: [positions[3 * index], positions[3 * index + 1], rig.target[2]] });
  }

  private changed(): void {
    this.places = null;
    this.view.invalidate();
  }

  private aim(rig: Rig): void {
    // What is being drawn lies on the picture as it was.
    this.surface.cancel();
    this.view.rig = rig;
    this.changed();
    this.tellView();
  }

  private resize(): void {
    this.surface.cancel();
    this.view.resize(this.element.clientWidth, this.element.clientHeight);
    this.changed();
    this.tellView();
  }

  /** Where and how large the bird's eye shows the plane, for whoever works on the page from outside. */
  private tellView(): void {
    const { target, span } = this.view.rig;
    this.element.dataset["target"] = `${target[0]} ${target[1]}`;
    this.element.dataset["metresPerPixel"] = String(span / this.view.size[1]);
  }

  private placed(): Float32Array {
    this.places ??= this.view.project(this.page.store.state.cloud.positions);
    return this.places;
  }

  /** Where the filter asks for something. */
  private drawAreas(context: CanvasRenderingContext2D): void {
    const { filter, cloud } = this.page.store.state;
    const here = filter.areas.filter((area) => liesIn(area, homeOf(this.page.store.state)));
    const pixels = here.map((area) => {
      const corners = cornersHere(area, cloud);
      const places = this.view.project(new Float32Array(corners.flatMap(([x, y]) => [x, y, 0])));
      return corners.map((_, i): Point => [places[2 * i], places[2 * i + 1]]);
    });
    drawAreas(context, pixels);
  }

  private tellCursor(): void {
    this.page.actions.view.cursor(this.pointer === null ? null : this.view.groundAt(...this.pointer));
  }

  private drawOverlay(): void {
    const [width, height] = this.view.size;
    const context = cleared(this.overlay, width, height);
    if (context === null) return;
    const { hover, dotSize, tool, brush, mode, cloud, shown } = this.page.store.state;
    if (mode !== "camera" && !this.view.isGone && shown.length === cloud.count)
      this.page.actions.review.saw(this.placed());
    this.drawAreas(context);
    drawRingLabels(context, (positions) => this.view.project(positions));
    if (this.above) {
      drawScaleBar(context, this.view.rig.span / height, width, height);
      drawAxes(context, height);
    }
    if (hover >= 0) drawHover(context, this.placed()[2 * hover], this.placed()[2 * hover + 1], dotSize / 2 + 4);
    if (this.gesture !== null) drawGesture(context, this.gesture, brush);
    else if (tool === "brush" && this.pointer !== null) drawBrushCursor(context, this.pointer, brush);
  }
}
