// Points on a canvas by WebGL: a buffer that grows, one draw call.

const VERTEX = `#version 300 es
in vec3 voxel; in float value;
uniform mat3 turn; uniform vec3 target; uniform vec2 scale; uniform vec2 shift; uniform float size;
uniform float voxelM; uniform vec2 heights; uniform float top; uniform bool byHeight, ink;
out vec3 color;
vec3 ramp(float t) {
  vec3 a = vec3(0.27, 0.0, 0.33), b = vec3(0.13, 0.57, 0.55), c = vec3(0.99, 0.91, 0.14);
  return t < 0.5 ? mix(a, b, 2.0 * t) : mix(b, c, 2.0 * t - 1.0);
}
void main() {
  vec3 p = (voxel + 0.5) * voxelM;
  vec3 q = turn * (p - target);
  gl_Position = vec4(q.xy * scale + shift, -q.z * 0.002, 1.0);
  if (p.z > top) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = size;
  float t = clamp((p.z - heights.x) / (heights.y - heights.x), 0.0, 1.0);
  float v = value / 255.0;
  color = byHeight ? ramp(ink ? 0.85 * t : t) : vec3(ink ? 0.72 * (1.0 - v) : 0.22 + 0.78 * v);
}`;
const FRAGMENT = `#version 300 es
precision mediump float; in vec3 color; out vec4 pixel;
void main() { pixel = vec4(color, 1.0); }`;

/**
 * @typedef {object} CloudView
 * @property {Float32Array | number[]} turn rotation by columns
 * @property {number[]} target what is in the middle [m]
 * @property {number[]} scale clip units per meter
 * @property {number[]} shift the target in clip units
 * @property {number} size of a point [px]
 * @property {number} top points above it are left out [m]
 * @property {boolean} byHeight whether height is color
 * @property {boolean} ink whether the background is light
 */

export class CloudCanvas {
  #canvas;
  /** @type {WebGL2RenderingContext | null} */
  #gl = null;
  /** @type {WebGLProgram | null} */
  #program = null;
  /** @type {Record<string, WebGLUniformLocation | null>} */
  #places = {};
  /** @type {{voxel: WebGLBuffer, value: WebGLBuffer} | null} */
  #buffers = null;
  #room = 0;
  #voxels = new Int16Array(0);
  #values = new Uint8Array(0);
  count = 0;
  voxelM = 0.1;
  heights = [-1.5, 2.5];

  constructor(/** @type {HTMLCanvasElement} */ canvas) {
    this.#canvas = canvas;
    canvas.addEventListener("webglcontextlost", (/** @type {Event} */ event) =>
      event.preventDefault(),
    );
    canvas.addEventListener("webglcontextrestored", () => this.#begin());
    this.#begin();
  }

  /** Whether the browser can draw points at all. */
  get works() {
    return this.#gl !== null;
  }

  /** Forgets all points. */
  clear() {
    this.count = 0;
  }

  /**
   * Adds points: x, y, z of each in voxels, then a value of each.
   * @param {ArrayBuffer} buffer
   * @param {number} count
   * @param {number} voxelM
   */
  add(buffer, count, voxelM) {
    this.voxelM = voxelM;
    this.#makeRoom(this.count + count);
    const voxels = new Int16Array(buffer.slice(0, 6 * count));
    const values = new Uint8Array(buffer, 6 * count, count);
    this.#voxels.set(voxels, 3 * this.count);
    this.#values.set(values, this.count);
    if (this.#buffers) {
      this.#write(this.#buffers.voxel, voxels, 6 * this.count);
      this.#write(this.#buffers.value, values, this.count);
    }
    this.count += count;
  }

  /**
   * Draws the points below the height `top`; `turn` is a rotation by columns, `scale` clip units
   * per meter, `shift` the target in clip units.
   */
  draw(/** @type {CloudView} */ { turn, target, scale, shift, size, top, byHeight, ink }) {
    const gl = this.#gl;
    if (!gl || gl.isContextLost()) return;
    gl.viewport(0, 0, this.#canvas.width, this.#canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const at = this.#places;
    gl.uniformMatrix3fv(at.turn, false, turn);
    gl.uniform3fv(at.target, target);
    gl.uniform2fv(at.scale, scale);
    gl.uniform2fv(at.shift, shift);
    gl.uniform1f(at.size, size);
    gl.uniform1f(at.top, top);
    gl.uniform1f(at.voxelM, this.voxelM);
    gl.uniform2fv(at.heights, this.heights);
    gl.uniform1i(at.byHeight, Number(byHeight));
    gl.uniform1i(at.ink, Number(ink));
    gl.drawArrays(gl.POINTS, 0, this.count);
  }

  #begin() {
    const gl = (this.#gl = this.#canvas.getContext("webgl2", { alpha: true, antialias: false }));
    if (!gl) return;
    const program = (this.#program = gl.createProgram());
    /** @type {Array<[number, string]>} */
    const sources = [
      [gl.VERTEX_SHADER, VERTEX],
      [gl.FRAGMENT_SHADER, FRAGMENT],
    ];
    for (const [kind, text] of sources) {
      const shader = gl.createShader(kind);
      if (!shader) return; // the context is lost
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    for (const name of [
      "turn",
      "target",
      "scale",
      "shift",
      "size",
      "voxelM",
      "heights",
      "top",
      "byHeight",
      "ink",
    ])
      this.#places[name] = gl.getUniformLocation(program, name);
    this.#room = 0;
    this.#makeRoom(Math.max(this.count, 1 << 14));
  }

  #makeRoom(/** @type {number} */ count) {
    if (count <= this.#room) return;
    this.#room = Math.max(2 * this.#room, count);
    const voxels = new Int16Array(3 * this.#room);
    const values = new Uint8Array(this.#room);
    voxels.set(this.#voxels.subarray(0, 3 * this.count));
    values.set(this.#values.subarray(0, this.count));
    [this.#voxels, this.#values] = [voxels, values];
    const gl = this.#gl;
    if (!gl) return;
    if (this.#buffers) Object.values(this.#buffers).forEach((buffer) => gl.deleteBuffer(buffer));
    this.#buffers = {
      voxel: this.#buffer(gl, "voxel", voxels, 3, gl.SHORT),
      value: this.#buffer(gl, "value", values, 1, gl.UNSIGNED_BYTE),
    };
  }

  /**
   * @param {WebGL2RenderingContext} gl
   * @param {"voxel" | "value"} name
   * @param {BufferSource} data
   * @param {number} size numbers of a point
   * @param {number} type of a number
   */
  #buffer(gl, name, data, size, type) {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    const place = this.#program ? gl.getAttribLocation(this.#program, name) : 0;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, false, 0, 0);
    return buffer;
  }

  /**
   * @param {WebGLBuffer} buffer
   * @param {BufferSource} data
   * @param {number} offset
   */
  #write(buffer, data, offset) {
    this.#gl?.bindBuffer(this.#gl.ARRAY_BUFFER, buffer);
    this.#gl?.bufferSubData(this.#gl.ARRAY_BUFFER, offset, data);
  }
}
