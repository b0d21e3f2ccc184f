// The canvas of the map: draws points while the camera moves, and all of them when it rests.

import { focalPx } from "./camera.js";
import { choose } from "./lod.js";
import { Pace } from "./pace.js";
import {
  MOST_PLANES,
  boundsOf,
  define,
  drawingTarget,
  giveColors,
  giveLook,
  groundOf,
  sheetOf,
} from "./materials.js";
import { drawerOf } from "./drawer.js";
import { placeCamera } from "./projection.js";
import { layersOf } from "./walk_layers.js";
import { MapTiles } from "./tiles.js";
import { PerspectiveCamera, Scene } from "../shared/vendor/three/three.module.min.js";

/**
 * @import {Camera, Screen} from "./camera.js"
 * @import {MapIndex} from "../shared/http_types"
 * @import {WebGLRenderTarget} from "../shared/vendor/three/three.module.min.js"
 * @import {ColorBy} from "./state.js"
 * @import {Reader, Stored} from "./tiles.js"
 * @import {CorePoints} from "./compare_points.js"
 * @import {MapBeside} from "./compare_swipe.js"
 * @typedef {object} Drawing what is drawn
 * @property {Camera} camera
 * @property {ColorBy} color
 * @property {[number, number]} ends of the colors, in the unit of the values
 * @property {number[][]} planes
 * @property {boolean} depth
 * @property {number} size
 * @property {boolean} dark
 * @property {{walk: boolean, nodes: boolean}} layers
 */

const REST_MS = 160;
const COMING_MS = 1000; // after the last movement: what is read for its images is awaited
const WARM_UP = 2; // first frames, in which shaders are compiled
const FIRST_SHARPNESS = 0.5; // of the first image: it is soon drawn again
const SHARPEST = 2; // pixels of the canvas per pixel of the page

export class MapCanvas {
  #canvas;
  #renderer;
  #index;
  #scene = new Scene();
  #lines = new Scene();
  #screenScene = new Scene();
  #camera = new PerspectiveCamera();
  #material;
  #screen;
  #coarse = drawingTarget();
  #fine = drawingTarget();
  /** @type {Drawing | null} */
  #drawing = null;
  #moved = -Infinity;
  /** @type {{queue: ReturnType<MapTiles["show"]>, next: number, late: boolean} | null} */
  #refining = null;
  #finished = false;
  #rough = false; // the image shown is one of a moving camera
  #fresh = false; // points have arrived that it lacks
  /** @type {boolean | null} */
  #hadPoints = null;
  /** @type {{sync: WebGLSync, began: number, points: number, moving: boolean} | null} */
  #pending = null;
  #asked = false;
  #refines = false;
  /** @type {Partial<ReturnType<typeof layersOf>>} */
  #layers = {};
  /** @type {CorePoints | null} */
  #differences = null;
  /** @type {MapBeside | null} */
  #beside = null;
  pace = new Pace();
  tiles;
  /** Figures of the last frames, for the caption and for tests. */
  drawn = { points: 0, ms: 0, frames: 0, rested: false };
  onDrawn = () => {};

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {MapIndex} index
   * @param {Reader} reader
   */
  constructor(canvas, index, reader) {
    this.#canvas = canvas;
    this.#index = index;
    const drawer = drawerOf(canvas);
    this.#renderer = drawer.renderer;
    this.#material = drawer.material;
    this.#screen = drawer.screen;
    Object.assign(this.#camera, { matrixWorldAutoUpdate: false, matrixAutoUpdate: false });
    for (const scene of [this.#scene, this.#lines, this.#screenScene])
      scene.matrixWorldAutoUpdate = false;
    this.#screenScene.add(sheetOf(this.#screen));
    this.tiles = new MapTiles(index, {
      scene: this.#scene,
      material: this.#material,
      reader,
      onLook: (look) => giveLook(this.#material, look, this.#drawing?.size),
    });
    this.tiles.onNews = () => this.#arrived();
    new ResizeObserver(() => this.#news()).observe(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.#news());
  }

  /** The canvas in pixels of the page. */
  get screen() {
    return {
      width: Math.max(this.#canvas.clientWidth, 1),
      height: Math.max(this.#canvas.clientHeight, 1),
    };
  }

  /** Draws something else, with fewer points at once: it may be one of the changes of a drag. */
  set drawing(/** @type {Drawing} */ drawing) {
    const before = this.#drawing;
    if (before && JSON.stringify(before) === JSON.stringify(drawing)) return;
    this.#drawing = drawing;
    if (before) this.#moved = performance.now();
    this.#news();
  }

  /** The walk and the nodes of the graph, as lines and dots over the map. */
  layers(/** @type {number[][]} */ walk, /** @type {number[][]} */ nodes) {
    this.#layers = layersOf(walk, nodes);
    for (const object of Object.values(this.#layers)) {
      Object.assign(object, { frustumCulled: false, visible: false });
      this.#lines.add(object);
    }
    this.#news();
  }

  /** Shows differences in place of the map; null = the map again. */
  differ(/** @type {CorePoints | null} */ points) {
    if (!points && !this.#differences) return;
    if (this.#differences) this.#scene.remove(this.#differences.object);
    if (points) this.#scene.add(points.object);
    points?.follow(this.#material);
    this.#differences = points;
    this.#news();
  }

  /** Shows another map to the right of its divider; null = this map only. */
  beside(/** @type {MapBeside | null} */ other) {
    if (!other && !this.#beside) return;
    if (other) other.tiles.onNews = () => this.#arrived();
    this.#beside = other;
    this.#moved = performance.now();
    this.#news();
  }

  /** From now on all points are drawn at rest: an image that holds up what is done meanwhile. */
  refine() {
    this.#refines = true;
    this.#ask();
  }

  /** Has the image drawn again: points have arrived, or its size has changed. */
  #news() {
    this.#finished = false;
    this.drawn.rested = false;
    this.#refining = null;
    this.#ask();
  }

  /**
   * Points have arrived: a drawing that has begun is shown before, so that one sees progress. One
   * at rest takes long: those of a view that is new are shown before it begins.
   */
  #arrived() {
    this.#fresh = this.#rough;
    if (!this.#refining) return this.#news();
    this.#refining.late = true;
    this.drawn.rested = false;
  }

  #ask() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#frame();
    });
  }

  #frame() {
    const drawing = this.#drawing;
    if (!drawing || !this.tiles.begun) return;
    if (!this.#isReady()) return this.#ask();
    const still = performance.now() - this.#moved;
    const moving = still < REST_MS;
    const first = this.#hadPoints !== this.tiles.total > 0; // few at once, before many
    const fresh = this.#fresh && !this.#refining;
    const coming = this.#rough && still < COMING_MS && this.#sides().some((one) => one.tiles.reads);
    if (moving || first || fresh) this.#drawCoarse(drawing);
    else if (!this.#finished && this.#refines && !coming) this.#refine(drawing);
    if (moving || (!this.#finished && this.#refines) || this.#pending) this.#ask();
    this.onDrawn();
  }

  /** Whether the frame before has been drawn; it says how long frames take. */
  #isReady() {
    if (!this.#pending) return true;
    const gl = this.#renderer.getContext();
    const { sync, began, points, moving } = this.#pending;
    const state = gl.clientWaitSync(sync, 0, 0);
    if (state === gl.TIMEOUT_EXPIRED && performance.now() - began < 5000) return false;
    gl.deleteSync(sync);
    this.#pending = null;
    const ms = performance.now() - began;
    Object.assign(this.drawn, { ms, frames: this.drawn.frames + 1 });
    if (moving && this.drawn.frames > WARM_UP) this.pace.note(points, ms);
    return true;
  }

  #begun(/** @type {number} */ began, /** @type {number} */ points, moving = false) {
    const gl = this.#renderer.getContext();
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (sync) this.#pending = { sync, began, points, moving };
  }

  #drawCoarse(/** @type {Drawing} */ drawing) {
    const began = performance.now();
    const drawnBefore = !this.#fresh; // new points take longer: they are handed to WebGL
    this.#refining = null;
    this.#rough = true;
    this.#fresh = false;
    this.#hadPoints = this.tiles.total > 0;
    const parts = this.#parts(drawing, this.pace.moving);
    this.#begin(drawing, this.#coarse);
    this.#paint(this.#coarse);
    this.#finish(drawing, this.#coarse);
    const points = parts.reduce((sum, part) => sum + part.points, this.#differences?.count ?? 0);
    Object.assign(this.drawn, { points, rested: false });
    this.#begun(began, points, drawnBefore);
  }

  /** Draws the next points of the drawing at rest; it is shown when it is complete. */
  #refine(/** @type {Drawing} */ drawing) {
    const began = performance.now();
    if (!this.#refining) {
      const queue = this.#parts(drawing, this.pace.resting);
      this.#refining = { queue, next: 0, late: false };
      this.#begin(drawing, this.#fine);
    }
    const { queue } = this.#refining;
    for (const { object } of queue) object.visible = false;
    let points = 0;
    while (this.#refining.next < queue.length && points < this.pace.moving) {
      const { object, points: more } = queue[this.#refining.next++];
      object.visible = true;
      points += more;
    }
    this.#paint(this.#fine);
    if (this.#refining.next >= queue.length) {
      this.#finish(drawing, this.#fine);
      this.#rough = this.#fresh = false;
      this.#finished = !this.#refining.late;
      const all = queue.reduce((sum, part) => sum + part.points, this.#differences?.count ?? 0);
      Object.assign(this.drawn, {
        points: all,
        rested: this.#finished && this.#sides().every(({ tiles }) => tiles.complete),
      });
      this.#refining = null;
    }
    this.#begun(began, points);
  }

  /** This map, and the other one. */
  #sides() {
    const own = { tiles: this.tiles, nodes: this.tiles.nodes };
    return this.#beside ? [own, this.#beside] : [own];
  }

  /**
   * Sets what is drawn of the maps within a budget; what is missing of it is read.
   * @param {Drawing} drawing
   * @param {number} budget
   */
  #parts({ camera, planes }, budget) {
    const sides = this.#sides();
    const view = { camera, screen: this.screen, planes, budget: budget / sides.length };
    return sides.flatMap(({ tiles, nodes }) => {
      const counts = this.#differences ? nodes.map(() => 0) : choose(nodes, view).counts;
      if (this.#refines) tiles.want(counts, camera);
      return tiles.show(counts);
    });
  }

  /** Draws what is visible; of two maps each on its side of the divider. */
  #paint(/** @type {WebGLRenderTarget} */ into) {
    const { width, height } = into;
    const split = Math.round(width * (this.#beside?.part ?? 1));
    const paint = (
      /** @type {Scene} */ scene,
      /** @type {number} */ from,
      /** @type {number} */ to,
    ) => {
      into.scissor.set(from, 0, to - from, height);
      this.#renderer.setRenderTarget(into);
      this.#renderer.render(scene, this.#camera);
    };
    into.scissorTest = this.#beside !== null;
    paint(this.#scene, 0, split);
    if (this.#beside) paint(this.#beside.scene, split, width);
    into.scissorTest = false;
    this.#renderer.setRenderTarget(into);
  }

  /**
   * @param {Drawing} drawing
   * @param {WebGLRenderTarget} into
   */
  #begin(drawing, into) {
    const { width, height } = this.screen;
    const coarse = this.drawn.points ? this.pace.sharpness : FIRST_SHARPNESS;
    const ratio = Math.min(devicePixelRatio, SHARPEST) * (into === this.#coarse ? coarse : 1);
    const [wide, tall] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (into.width !== wide || into.height !== tall) into.setSize(wide, tall);
    const nodes = this.#sides().flatMap((side) => side.nodes);
    const view = { screen: this.screen, bounds: boundsOf(nodes.filter(({ cube }) => cube < 0)) };
    const { near, far, turn } = placeCamera(this.#camera, drawing.camera, view);
    this.#material.uniforms.turn.value = turn;
    define(this.#material, "DISCS", into === this.#fine);
    define(this.#screen, "FINE", into === this.#fine);
    this.#look(drawing, ratio);
    const { uniforms } = this.#screen;
    if (drawing.camera.parallel) uniforms.nearness.value.set(-near, near - far);
    else uniforms.nearness.value.set(1 / near, 1 / far - 1 / near);
    uniforms.scale.value = drawing.camera.parallel ? 1 / drawing.camera.distance : 0;
    uniforms.strength.value = drawing.depth ? 25 : 0;
    uniforms.ground.value.set(...groundOf(drawing.dark));
    this.#renderer.setRenderTarget(into);
    this.#renderer.setClearColor(0, 1);
    this.#renderer.clear();
  }

  /**
   * @param {Drawing} drawing
   * @param {number} ratio
   */
  #look({ camera, color, ends, planes, dark, layers }, ratio) {
    const { uniforms } = this.#material;
    const focal = focalPx(this.screen) * ratio;
    uniforms.parallel.value = camera.parallel;
    uniforms.focal.value = camera.parallel ? focal / camera.distance : focal;
    uniforms.sizes.value.set(ratio, 24 * ratio);
    uniforms.mode.value = { height: 0, class: 2, plain: 3 }[/** @type {string} */ (color)] ?? 1;
    uniforms.ends.value.set(...this.#endsOf(color, ends));
    giveColors(this.#material, color, dark);
    planes.slice(0, MOST_PLANES).forEach(([x, y, z, d], k) => {
      uniforms.planes.value[k].set(x, y, z, d);
    });
    uniforms.planeCount.value = Math.min(planes.length, MOST_PLANES);
    this.#material.uniformsNeedUpdate = true;
    this.#beside?.follow(this.#material, { color, ends });
    this.#differences?.follow(this.#material);
    if (this.#layers.walk) this.#layers.walk.visible = layers.walk;
    if (this.#layers.nodes) this.#layers.nodes.visible = layers.nodes;
  }

  /**
   * Ends of the colors as the shader compares them: of values as fractions of their 16 bits.
   * @param {ColorBy} color
   * @param {[number, number]} ends
   * @returns {[number, number]}
   */
  #endsOf(color, ends) {
    const column = this.#index.columns.find(({ name }) => name === color);
    if (!column) return ends;
    const { offset, scale } = column;
    const [low, high] = ends.map((value) => (value - offset) / scale / 65535);
    return [low, high];
  }

  /**
   * @param {Drawing} drawing
   * @param {WebGLRenderTarget} from
   */
  #finish(drawing, from) {
    const { uniforms } = this.#screen;
    uniforms.colors.value = from.texture;
    uniforms.depths.value = from.depthTexture;
    if (this.#canvas.width !== from.width || this.#canvas.height !== from.height)
      this.#renderer.setSize(from.width, from.height, false);
    this.#renderer.setRenderTarget(null);
    this.#renderer.render(this.#screenScene, this.#camera);
    if (drawing.layers.walk || drawing.layers.nodes)
      this.#renderer.render(this.#lines, this.#camera);
  }
}
