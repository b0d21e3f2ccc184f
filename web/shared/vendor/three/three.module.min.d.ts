// The types of three.js, as far as the page Map uses them.

export class Vector2 {
  constructor(x?: number, y?: number);
  x: number;
  y: number;
  set(x: number, y: number): this;
}
export class Vector3 {
  constructor(x?: number, y?: number, z?: number);
  x: number;
  y: number;
  z: number;
  set(x: number, y: number, z: number): this;
}
export class Vector4 {
  constructor(x?: number, y?: number, z?: number, w?: number);
  set(x: number, y: number, z: number, w: number): this;
}
export class Color {
  constructor(color?: string | number);
  r: number;
  g: number;
  b: number;
  set(color: string | number): this;
  setRGB(r: number, g: number, b: number): this;
}
export class Matrix4 {
  elements: number[];
  set(...elements: number[]): this;
  copy(matrix: Matrix4): this;
  invert(): this;
  premultiply(matrix: Matrix4): this;
}
export class BufferAttribute {
  constructor(
    array: Uint8Array | Int8Array | Uint16Array | Float32Array,
    itemSize: number,
    normalized?: boolean,
  );
  array: ArrayLike<number>;
}
export class BufferGeometry {
  setAttribute(name: string, attribute: BufferAttribute): this;
  deleteAttribute(name: string): this;
  setDrawRange(start: number, count: number): void;
  dispose(): void;
}
export class Object3D {
  visible: boolean;
  frustumCulled: boolean;
  matrixAutoUpdate: boolean;
  matrixWorldAutoUpdate: boolean;
  renderOrder: number;
  matrix: Matrix4;
  matrixWorld: Matrix4;
  add(...objects: Object3D[]): this;
  remove(...objects: Object3D[]): this;
  onBeforeRender: () => void;
}
export class Scene extends Object3D {}
export class Camera extends Object3D {
  projectionMatrix: Matrix4;
  projectionMatrixInverse: Matrix4;
  matrixWorldInverse: Matrix4;
}
export class PerspectiveCamera extends Camera {
  constructor(fov?: number, aspect?: number, near?: number, far?: number);
}
export class OrthographicCamera extends Camera {
  constructor(
    left?: number,
    right?: number,
    top?: number,
    bottom?: number,
    near?: number,
    far?: number,
  );
}
export class Material {
  depthTest: boolean;
  depthWrite: boolean;
  transparent: boolean;
  opacity: number;
  dispose(): void;
}
export class RawShaderMaterial extends Material {
  constructor(options: object);
  uniforms: Record<string, { value: any }>;
  uniformsNeedUpdate: boolean;
  defines: Record<string, string>;
  needsUpdate: boolean;
}
export class LineBasicMaterial extends Material {
  constructor(options: object);
  color: Color;
}
export class PointsMaterial extends Material {
  constructor(options: object);
  color: Color;
}
export class Points extends Object3D {
  constructor(geometry: BufferGeometry, material: Material);
  geometry: BufferGeometry;
}
export class Line extends Object3D {
  constructor(geometry: BufferGeometry, material: Material);
  geometry: BufferGeometry;
}
export class LineSegments extends Line {}
export class Mesh extends Object3D {
  constructor(geometry: BufferGeometry, material: Material);
  geometry: BufferGeometry;
}
export class DepthTexture {
  constructor(width: number, height: number, type?: number);
  dispose(): void;
}
export class WebGLRenderTarget {
  constructor(width: number, height: number, options?: object);
  texture: object;
  depthTexture: DepthTexture;
  width: number;
  height: number;
  scissor: Vector4;
  scissorTest: boolean;
  setSize(width: number, height: number): void;
  dispose(): void;
}
export class WebGLRenderer {
  constructor(options: object);
  autoClear: boolean;
  outputColorSpace: string;
  setPixelRatio(ratio: number): void;
  setSize(width: number, height: number, style?: boolean): void;
  setRenderTarget(target: WebGLRenderTarget | null): void;
  setClearColor(color: Color | number, alpha?: number): void;
  clear(): void;
  render(scene: Object3D, camera: Camera): void;
  getContext(): WebGL2RenderingContext;
  dispose(): void;
}
export const GLSL3: string;
export const NearestFilter: number;
export const NoBlending: number;
export const UnsignedIntType: number;
