// The core points of a comparison in the scene: discs as large as they are apart.

import { colorsOf, decoded } from "./compare_colors.js";
import { MOST_PLANES, define } from "./materials.js";
import { LAID_POINT, POINT_FRAGMENT } from "./shaders.js";
import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  NoBlending,
  Points,
  RawShaderMaterial,
  Vector2,
  Vector4,
} from "../shared/vendor/three/three.module.min.js";

const WIDER = 1.5; // than core points are apart: no holes between them

const VERTEX = `${LAID_POINT}
uniform mat4 modelViewMatrix;
uniform float wide;     // of a point [m]
in vec3 position;
in vec3 normal;
in vec3 shade;
flat out vec3 color;

void main() {
  vec3 seen = (modelViewMatrix * vec4(position, 1.0)).xyz;
  color = shade * lay(position, seen, normal, wide);
}`;

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
      fragmentShader: POINT_FRAGMENT,
      defines: {},
      blending: NoBlending,
      uniforms: {
        turn: { value: [1, 0, 0, 0, 1, 0, 0, 0, 1] },
        focal: { value: 1 },
        parallel: { value: false },
        wide: { value: WIDER * spacing },
        sizes: { value: new Vector2(1, 64) },
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
    this.object.geometry.setAttribute("shade", colors);
  }

  /** Takes what the material of the map is given: camera, clip planes, and whether it has discs. */
  follow(/** @type {RawShaderMaterial} */ { uniforms: of, defines }) {
    const { turn, focal, parallel, planes, planeCount } = of;
    Object.assign(this.#material.uniforms, { turn, focal, parallel, planes, planeCount });
    define(this.#material, "DISCS", "DISCS" in defines);
    this.#material.uniformsNeedUpdate = true;
  }

  dispose() {
    this.object.geometry.dispose();
    this.#material.dispose();
  }
}
