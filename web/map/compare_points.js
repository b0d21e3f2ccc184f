// The core points of a comparison in the scene: discs as large as they are apart.

import { colorsOf, decoded } from "./compare_colors.js";
import { MOST_PLANES } from "./materials.js";
import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  NoBlending,
  Points,
  RawShaderMaterial,
  Vector4,
} from "../shared/vendor/three/three.module.min.js";

const WIDER = 1.5; // than core points are apart: no holes between them

const VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 turn;      // from the map to the eye
uniform float focal;    // pixels of a meter at a meter's distance; parallel: at any distance
uniform bool parallel;
uniform float wide;     // of a point [m]
uniform float most;     // largest point [px]
uniform vec4 planes[${MOST_PLANES}];
uniform int planeCount;
in vec3 position;
in vec3 normal;
in vec3 color;
flat out vec3 shade;

void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  for (int k = 0; k < planeCount; k++)
    if (dot(planes[k].xyz, position) + planes[k].w < 0.0) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      gl_PointSize = 1.0;
      return;
    }
  float away = parallel ? 1.0 : max(-seen.z, 0.01);
  gl_PointSize = clamp(wide * focal / away, 1.0, most);
  shade = color;
  if (dot(normal, normal) > 0.2) {
    vec3 toEye = parallel ? vec3(0.0, 0.0, 1.0) : normalize(-seen.xyz);
    shade *= 0.76 + 0.24 * abs(dot(turn * normal, toEye));
  }
}`;
const FRAGMENT = `
precision mediump float;
flat in vec3 shade;
out vec4 pixel;
void main() { pixel = vec4(shade, 1.0); }`;

/** Points that are colored by their differences. */
export class CorePoints {
  #points;
  #material;
  object;

  /**
   * @param {ArrayBuffer} data as the server sends it
   * @param {{step: number, spacing: number}} sizes [m]
   */
  constructor(data, { step, spacing }) {
    this.#points = decoded(data, step);
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      blending: NoBlending,
      uniforms: {
        turn: { value: [1, 0, 0, 0, 1, 0, 0, 0, 1] },
        focal: { value: 1 },
        parallel: { value: false },
        wide: { value: WIDER * spacing },
        most: { value: 64 },
        planes: { value: Array.from({ length: MOST_PLANES }, () => new Vector4()) },
        planeCount: { value: 0 },
      },
    });
    const geometry = new BufferGeometry();
    const { places, normals } = this.#points;
    geometry.setAttribute("position", new BufferAttribute(places, 3));
    geometry.setAttribute("normal", new BufferAttribute(normals, 3, true));
    this.object = new Points(geometry, this.#material);
    Object.assign(this.object, {
      matrixAutoUpdate: false,
      matrixWorldAutoUpdate: false,
      frustumCulled: false,
    });
  }

  get count() {
    return this.#points.count;
  }

  /** Colors them: distance at the ends of the colors [m]. */
  color(/** @type {number} */ reach) {
    const colors = new BufferAttribute(colorsOf(this.#points, reach), 3, true);
    this.object.geometry.setAttribute("color", colors);
  }

  /** Takes what the material of the map is given: camera and clip planes. */
  follow(
    /** @type {Record<string, {value: any}>} */ { turn, focal, parallel, planes, planeCount },
  ) {
    const { uniforms } = this.#material;
    Object.assign(uniforms, { turn, focal, parallel, planes, planeCount });
    this.#material.uniformsNeedUpdate = true;
  }

  dispose() {
    this.object.geometry.dispose();
    this.#material.dispose();
  }
}
