/** The WebGL picture: bird's eye and free view of the same scene, drawn only when something has changed. */

import {
  Color,
  OrthographicCamera,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
  Matrix4,
} from "three";
import { hasSmoothEdges } from "./graphics.js";
import { ground } from "./ground.js";
import { LidarCloud } from "./lidar-cloud.js";
import { projectAll } from "./project.js";
import { RadarCloud } from "./radar-cloud.js";
import { eye, eyeDistance, FIELD_OF_VIEW, HOME, type Rig } from "./rig.js";

const BACKGROUND = 0x0b0e13;
const LIGHT_BACKGROUND = 0xe9edf2;
const FAR_ABOVE = 500;

export class SceneView {
  readonly radar = new RadarCloud();
  readonly lidar = new LidarCloud();
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly above = new OrthographicCamera();
  private readonly free = new PerspectiveCamera((FIELD_OF_VIEW * 180) / Math.PI, 1, 0.5, 3000);
  private readonly level = new Plane(new Vector3(0, 0, 1), 0);
  private readonly caster = new Raycaster();
  private currentRig: Rig = HOME;
  private bird = true;
  private width = 1;
  private height = 1;
  private asked = 0;

  /** `drawOver` draws what lies over it, `timed` hears how many milliseconds passed until both were painted. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly drawOver: () => void,
    private readonly timed: (milliseconds: number) => void,
    /** Hears that the graphics card was taken away, with nothing drawn until it is back. */
    gone: () => void,
  ) {
    const antialias = hasSmoothEdges();
    this.renderer = new WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(this.pixelRatio);
    this.scene.background = new Color(BACKGROUND);
    this.scene.add(ground(), this.lidar.points, this.radar.points);
    canvas.addEventListener("webglcontextlost", gone);
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    this.free.up.set(0, 0, 1);
    this.above.up.set(1, 0, 0);
  }

  get pixelRatio(): number {
    return Math.min(window.devicePixelRatio, 2);
  }

  /** Whether nothing is on the canvas, whatever is drawn. */
  get isGone(): boolean {
    return this.renderer.getContext().isContextLost();
  }

  get rig(): Rig {
    return this.currentRig;
  }

  set rig(rig: Rig) {
    this.currentRig = rig;
    this.aim();
  }

  setBird(bird: boolean): void {
    this.bird = bird;
    this.aim();
  }

  setLight(light: boolean): void {
    this.scene.background = new Color(light ? LIGHT_BACKGROUND : BACKGROUND);
    this.invalidate();
  }

  resize(width: number, height: number): void {
    [this.width, this.height] = [Math.max(width, 1), Math.max(height, 1)];
    this.renderer.setSize(this.width, this.height, false);
    this.aim();
  }

  get size(): readonly [number, number] {
    return [this.width, this.height];
  }

  /** Draws with the next frame, once however often it's asked. */
  invalidate(): void {
    if (this.asked !== 0) return;
    this.asked = requestAnimationFrame(() => {
      this.asked = 0;
      const began = performance.now();
      this.renderer.render(this.scene, this.camera);
      this.drawOver();
      // A frame isn't done before the graphics card is: what was asked of it is waited for with the next one.
      requestAnimationFrame(() => this.timed(performance.now() - began));
    });
  }

  /** Pixels of places in metres; NaN outside the picture. */
  project(positions: Float32Array): Float32Array {
    const clip = new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    return projectAll(clip.elements, positions, this.width, this.height);
  }

  /** Where the ground plane (z = 0) is under a pixel, m; `null` above the horizon. */
  groundAt(x: number, y: number): readonly [number, number] | null {
    const pixel = new Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height);
    this.caster.setFromCamera(pixel, this.camera);
    const hit = this.caster.ray.intersectPlane(this.level, new Vector3());
    return hit === null ? null : [hit.x, hit.y];
  }

  private get camera(): OrthographicCamera | PerspectiveCamera {
    return this.bird ? this.above : this.free;
  }

  private aim(): void {
    const [x, y, z] = this.currentRig.target;
    this.radar.setReference(this.bird ? 0 : eyeDistance(this.currentRig));
    if (this.bird) this.aimAbove(x, y);
    else this.aimFree(x, y, z);
    this.camera.updateMatrixWorld();
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  private aimAbove(x: number, y: number): void {
    const halfHeight = this.currentRig.span / 2;
    const halfWidth = (halfHeight * this.width) / this.height;
    const camera = this.above;
    [camera.left, camera.right, camera.top, camera.bottom] = [-halfWidth, halfWidth, halfHeight, -halfHeight];
    [camera.near, camera.far] = [1, 2 * FAR_ABOVE];
    camera.position.set(x, y, FAR_ABOVE);
    camera.lookAt(x, y, 0);
  }

  private aimFree(x: number, y: number, z: number): void {
    const camera = this.free;
    camera.aspect = this.width / this.height;
    camera.near = Math.max(eyeDistance(this.currentRig) / 200, 0.1);
    camera.position.set(...eye(this.currentRig));
    camera.lookAt(x, y, z);
  }
}
