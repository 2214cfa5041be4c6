/** A LiDAR scan as one buffer of points; the columns go to the graphics card as they came. */

import { BufferAttribute, BufferGeometry, Matrix4, Points, ShaderMaterial } from "three";
import type { Lidar } from "../data/lidar.js";

const VERTEX = `
attribute float px;
attribute float py;
attribute float pz;
attribute float ground;
uniform float size;
uniform bool hideGround;
varying float vHeight;

void main() {
  vec4 place = modelMatrix * vec4(px, py, pz, 1.0);
  vHeight = clamp((place.z + 0.5) / 4.5, 0.0, 1.0);
  gl_PointSize = size;
  gl_Position = projectionMatrix * viewMatrix * place;
  if (hideGround && ground > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const FRAGMENT = `
varying float vHeight;

void main() {
  vec3 low = vec3(0.235, 0.270, 0.325);
  vec3 high = vec3(0.590, 0.635, 0.690);
  gl_FragColor = vec4(mix(low, high, vHeight), 1.0);
}`;

export class LidarCloud {
  readonly points: Points<BufferGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { size: { value: 1.5 }, hideGround: { value: true } },
    });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.matrixAutoUpdate = false;
    this.points.renderOrder = 2;
    this.points.visible = false;
  }

  set(lidar: Lidar | null): void {
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    if (lidar !== null) {
      geometry.setAttribute("px", new BufferAttribute(lidar.x, 1));
      geometry.setAttribute("py", new BufferAttribute(lidar.y, 1));
      geometry.setAttribute("pz", new BufferAttribute(lidar.z, 1));
      geometry.setAttribute("ground", new BufferAttribute(lidar.ground, 1));
      geometry.setDrawRange(0, lidar.count);
      const m = lidar.vehicleFromLidarTime;
      this.points.matrix = new Matrix4().fromArray(m as number[]).transpose();
    }
    this.points.geometry = geometry;
  }

  setLook(visible: boolean, hideGround: boolean, pixelRatio: number): void {
    this.points.visible = visible && this.points.geometry.getAttribute("px") !== undefined;
    this.points.material.uniforms["hideGround"].value = hideGround;
    this.points.material.uniforms["size"].value = 1.5 * pixelRatio;
  }
}
