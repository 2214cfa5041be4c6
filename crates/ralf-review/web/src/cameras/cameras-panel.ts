/** All cameras of the moment: one large, the others small beside it. */

import { busiest } from "../data/camera-moment.js";
import { h, pressed } from "../dom.js";
import type { Page } from "../page.js";
import { iconButton } from "../panels/buttons.js";
import { CameraView } from "./camera-view.js";

export class CamerasPanel {
  readonly element: HTMLElement;
  private readonly large: CameraView;
  private readonly strip = h("div", { class: "camera-strip" });
  private readonly small: Thumb[] = [];

  constructor(private readonly page: Page) {
    const { store, actions } = page;
    this.large = new CameraView(page);
    this.large.element.classList.add("large");
    const grow = iconButton(
      "grow",
      "Show this camera in the centre (W)",
      () => actions.view.toggleCameraMode(),
      "grow",
    );
    const stage = h("div", { class: "camera-stage" }, this.large.element, grow, lidarButton(page));
    this.element = h("section", { class: "cameras", "aria-label": "Cameras" }, stage, this.strip);
    store.watch(
      ({ cameras, chosenCamera }) => [cameras, chosenCamera],
      () => this.show(),
    );
  }

  /** The camera that is shown large. */
  get seen(): string | null {
    const { cameras, chosenCamera, cloud } = this.page.store.state;
    return cameras.some(({ info }) => info.name === chosenCamera) ? chosenCamera : busiest(cameras, cloud);
  }

  private show(): void {
    const { cameras } = this.page.store.state;
    const { seen } = this;
    this.element.classList.toggle("empty", cameras.length === 0);
    const large = cameras.find(({ info }) => info.name === seen) ?? null;
    if (large !== null)
      this.large.element.style.setProperty("aspect-ratio", `${large.info.width} / ${large.info.height}`);
    this.large.show(large);
    const others = cameras.filter((camera) => camera !== large);
    while (this.small.length < others.length) this.small.push(this.pickable(this.small.length));
    this.small.forEach(({ thumb, view }, i) => {
      const camera = others[i] ?? null;
      thumb.hidden = camera === null;
      if (camera !== null)
        view.element.style.setProperty("aspect-ratio", `${camera.info.width} / ${camera.info.height}`);
      view.show(camera);
    });
  }

  private pickable(index: number): Thumb {
    const choose = (): void => {
      const camera = this.page.store.state.cameras.filter(({ info }) => info.name !== this.seen)[index];
      if (camera !== undefined) this.page.actions.view.camera(camera.info.name);
    };
    const view = new CameraView(this.page);
    const button = iconButton("grow", "Show this camera large (Q: next)", choose, "grow");
    const thumb = h("div", { class: "camera-thumb" }, view.element, button);
    this.strip.append(thumb);
    return { thumb, view };
  }
}

/** Whether the LiDAR is drawn into the images. */
function lidarButton({ store, actions }: Page): HTMLElement {
  const toggle = (): void => actions.view.toggleLidarInImages();
  const button = iconButton("overlay", "LiDAR in the cameras' images (Shift K)", toggle, "over-image");
  store.watch(
    ({ lidarInImages }) => [lidarInImages],
    (on) => pressed(button, on),
  );
  return button;
}

interface Thumb {
  readonly thumb: HTMLElement;
  readonly view: CameraView;
}
