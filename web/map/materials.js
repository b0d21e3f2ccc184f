// What the canvas of the map draws with: materials, targets, colors.

import { classColor, rampOf } from "./colors.js";
import { DEPTH_FRAGMENT, POINT_FRAGMENT, POINT_VERTEX, SCREEN_VERTEX } from "./shaders.js";
import {
  BufferAttribute,
  BufferGeometry,
  DepthTexture,
  GLSL3,
  Mesh,
  NearestFilter,
  NoBlending,
  RawShaderMaterial,
  UnsignedIntType,
  Vector2,
  Vector3,
  Vector4,
  WebGLRenderTarget,
  WebGLRenderer,
} from "../shared/vendor/three/three.module.min.js";
import { t } from "../shared/texts.js";

/**
 * @import {MapNode} from "./nodes.js"
 * @import {Material} from "../shared/vendor/three/three.module.min.js"
 */

export const MOST_PLANES = 12;
const GROUNDS = { dark: [0.063, 0.078, 0.094], light: [0.914, 0.93, 0.941] };
const PLAIN = { dark: [209, 214, 219], light: [189, 194, 201] };
const CLASS_CODES = 68;
const RAMP = 17;
const [PLAIN_AT, COLORS] = [RAMP + CLASS_CODES, RAMP + CLASS_CODES + 2]; // then unknown values
const CUBE_TILES = 64; // most tiles of a cube

/** The color where nothing is. */
export const groundOf = (/** @type {boolean} */ dark) => GROUNDS[dark ? "dark" : "light"];

/** The box of all points: what is drawn lies in it. */
export function boundsOf(/** @type {Array<Pick<MapNode, "low_m" | "high_m">>} */ boxes) {
  /**
   * @param {"low_m" | "high_m"} end
   * @param {(...of: number[]) => number} best
   */
  const all = (end, best) =>
    [0, 1, 2].map((axis) =>
      boxes.reduce((found, box) => best(found, box[end][axis]), boxes[0]?.[end][axis] ?? 0),
    );
  return { low: all("low_m", Math.min), high: all("high_m", Math.max) };
}

/** What draws on a canvas. */
export function rendererOf(/** @type {HTMLCanvasElement} */ canvas) {
  const context = canvas.getContext("webgl2", { antialias: false });
  if (context) return new WebGLRenderer({ canvas, context, antialias: false, alpha: false });
  throw new Error(t("no-webgl-3d"));
}

/** Colors and depths of an image. */
export const drawingTarget = () =>
  new WebGLRenderTarget(1, 1, {
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthTexture: new DepthTexture(1, 1, UnsignedIntType),
  });

/** A triangle that covers the image. */
export function sheetOf(/** @type {Material} */ material) {
  const corners = new BufferGeometry();
  const triangle = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
  corners.setAttribute("position", new BufferAttribute(triangle, 3));
  const sheet = new Mesh(corners, material);
  sheet.frustumCulled = false;
  return sheet;
}

const vectors = (/** @type {number} */ count) => Array.from({ length: count }, () => new Vector3());

const put = (/** @type {Vector3} */ color, /** @type {number[]} */ [red, green, blue]) =>
  color.set(red / 255, green / 255, blue / 255);

export function pointMaterial() {
  const colors = vectors(COLORS);
  for (let code = 0; code < CLASS_CODES; code++) put(colors[RAMP + code], classColor(code));
  colors[COLORS - 1].set(0.5, 0.5, 0.52);
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: POINT_VERTEX,
    fragmentShader: POINT_FRAGMENT,
    defines: {},
    blending: NoBlending,
    uniforms: {
      thinned: { value: new Float32Array(CUBE_TILES).fill(1) },
      focal: { value: 1 },
      parallel: { value: false },
      turn: { value: [1, 0, 0, 0, 1, 0, 0, 0, 1] },
      sizes: { value: new Vector2(1, 14) },
      mode: { value: 0 },
      known: { value: true },
      ends: { value: new Vector2(0, 1) },
      colors: { value: colors },
      planes: { value: Array.from({ length: MOST_PLANES }, () => new Vector4()) },
      planeCount: { value: 0 },
    },
  });
}

/**
 * Sets the ramp of the colors, and the color of the shape alone.
 * @param {RawShaderMaterial} material
 * @param {import("./state.js").ColorBy} color
 * @param {boolean} dark
 */
export function giveColors({ uniforms }, color, dark) {
  const { value } = uniforms.colors;
  rampOf(color).forEach((rgb, k) => put(value[k], rgb));
  put(value[PLAIN_AT], PLAIN[dark ? "dark" : "light"]);
}

/**
 * Compiles a shader for an image at rest, with large points as discs, or for one of a moving
 * camera, which is drawn faster.
 * @param {RawShaderMaterial} material
 * @param {"DISCS" | "FINE"} name
 * @param {boolean} on
 */
export function define(material, name, on) {
  if (name in material.defines === on) return;
  material.defines = on ? { [name]: "" } : {};
  material.needsUpdate = true;
}

export const screenMaterial = () =>
  new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: SCREEN_VERTEX,
    fragmentShader: DEPTH_FRAGMENT,
    defines: {},
    blending: NoBlending,
    depthTest: false,
    depthWrite: false,
    uniforms: {
      colors: { value: null },
      depths: { value: null },
      nearness: { value: new Vector2(1, -1) },
      scale: { value: 1 },
      strength: { value: 1 },
      ground: { value: new Vector3() },
    },
  });

/**
 * Sets what the shader is given for the points of a chunk.
 * @param {RawShaderMaterial} material
 * @param {import("./tiles.js").Look} look
 * @param {number} size
 */
export function giveLook(material, { thinned, known }, size = 1) {
  const { uniforms } = material;
  thinned.forEach((times, k) => (uniforms.thinned.value[k] = times * size));
  uniforms.known.value = known;
  material.uniformsNeedUpdate = true;
}
