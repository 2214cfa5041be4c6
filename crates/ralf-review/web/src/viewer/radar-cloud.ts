/** All detections on screen as one buffer of points: colour inside, state as the rim. */

import { BufferAttribute, BufferGeometry, Points, ShaderMaterial, Sphere } from "three";
import { Mark, type Marks } from "./marks.js";
import { CORRECTED_RGB, type Rgb, SELECTED_RGB, UNCERTAIN_RGB, WAITING_RGB } from "./palette.js";

const VERTEX = `
attribute vec3 tint;
attribute float mark;
uniform float size;
uniform float reference;
varying vec3 vTint;
varying float vMark;
varying float vSize;

void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  float nearness = reference > 0.0 ? clamp(pow(reference / max(-place.z, 0.1), 0.6), 0.55, 1.7) : 1.0;
  vTint = tint;
  vMark = mark;
  bool selected = mark == ${Mark.selected}.0;
  bool context = mark == ${Mark.context}.0;
  bool waiting = mark == ${Mark.waiting}.0;
  vSize = size * nearness * (selected || waiting ? 1.3 : context ? 0.72 : 1.0);
  gl_PointSize = vSize;
  gl_Position = projectionMatrix * place;
  if (mark == ${Mark.hidden}.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const FRAGMENT = `
varying vec3 vTint;
varying float vMark;
varying float vSize;

void main() {
  float radius = length(gl_PointCoord - 0.5) * vSize;
  float outer = vSize * 0.5 - 0.5;
  if (radius > outer + 0.5) discard;
  float rim = max(vSize * 0.14, 1.2);
  vec3 edge = vTint * 0.25;
  if (vMark == ${Mark.uncertain}.0) edge = ${glsl(UNCERTAIN_RGB)};
  if (vMark == ${Mark.corrected}.0) edge = ${glsl(CORRECTED_RGB)};
  if (vMark == ${Mark.selected}.0) { edge = ${glsl(SELECTED_RGB)}; rim *= 1.3; }
  if (vMark == ${Mark.waiting}.0) {
    // A broken rim: told by its shape, whatever colours one sees.
    vec2 place = gl_PointCoord - 0.5;
    bool gap = fract(atan(place.y, place.x) * ${(6 / (2 * Math.PI)).toFixed(4)}) < 0.45;
    edge = gap ? vec3(0.04) : ${glsl(WAITING_RGB)};
    rim *= 1.7;
  }
  vec3 colour = mix(vTint, edge, smoothstep(outer - rim - 0.6, outer - rim + 0.4, radius));
  float alpha = clamp(outer + 0.5 - radius, 0.0, 1.0) * (vMark == ${Mark.context}.0 ? 0.42 : 1.0);
  gl_FragColor = vec4(colour, alpha);
}`;

export class RadarCloud {
  readonly points: Points<BufferGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { size: { value: 8 }, reference: { value: 0 } },
      transparent: true,
    });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 3;
  }

  /** x, y, z of every detection, m. */
  setPositions(positions: Float32Array): void {
    const count = positions.length / 3;
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(positions, 3));
    geometry.setAttribute("tint", new BufferAttribute(new Uint8Array(3 * count), 3, true));
    geometry.setAttribute("mark", new BufferAttribute(new Uint8Array(count).fill(Mark.hidden), 1));
    // It would be worked out for an order of drawing that is given; places that are none have none.
    geometry.boundingSphere = new Sphere();
    this.points.geometry = geometry;
  }

  setColours(colours: Uint8Array): void {
    this.replace("tint", colours);
  }

  setMarks(marks: Marks): void {
    this.replace("mark", marks);
  }

  /** Diameter in device pixels. */
  setSize(size: number): void {
    this.points.material.uniforms["size"].value = size;
  }

  /**
   * In the free view dots shrink with their distance; at `reference` metres they have their size. 0: seen from above,
   * where all have the same size and nothing hides them.
   */
  setReference(reference: number): void {
    this.points.material.uniforms["reference"].value = reference;
    this.points.material.depthTest = reference > 0;
  }

  private replace(name: string, values: Uint8Array): void {
    const attribute = this.points.geometry.getAttribute(name);
    if (!(attribute instanceof BufferAttribute) || attribute.array.length !== values.length) return;
    attribute.array.set(values);
    attribute.needsUpdate = true;
  }
}

function glsl(rgb: Rgb): string {
  return `vec3(${rgb.map((channel) => (channel / 255).toFixed(4)).join(", ")})`;
}
