// What draws the map. Without a graphics card most of the time until the first image goes to
// compiling shaders, so it begins while the other scripts of the page still load.

import {
  drawingTarget,
  groundOf,
  pointMaterial,
  rendererOf,
  screenMaterial,
  sheetOf,
} from "./materials.js";
import {
  BufferAttribute,
  BufferGeometry,
  PerspectiveCamera,
  Points,
} from "../shared/vendor/three/three.module.min.js";

/** @type {WeakMap<HTMLCanvasElement, ReturnType<typeof begin>>} */
const begun = new WeakMap();

/** What draws on a canvas. */
export function drawerOf(/** @type {HTMLCanvasElement} */ canvas) {
  const drawer = begun.get(canvas) ?? begin(canvas);
  begun.set(canvas, drawer);
  return drawer;
}

function begin(/** @type {HTMLCanvasElement} */ canvas) {
  const renderer = rendererOf(canvas);
  renderer.autoClear = false;
  return { renderer, material: pointMaterial(), screen: screenMaterial() };
}

/** The attributes of a chunk, for one point. */
function onePoint() {
  const geometry = new BufferGeometry();
  geometry.setAttribute("place", new BufferAttribute(new Uint16Array(3), 3, true));
  geometry.setAttribute("about", new BufferAttribute(new Int8Array(4), 4, true));
  geometry.setAttribute("apart", new BufferAttribute(new Uint8Array(1), 1, true));
  geometry.setAttribute("slot", new BufferAttribute(new Uint8Array(1), 1));
  geometry.setAttribute("value", new BufferAttribute(new Uint16Array(1), 1, true));
  return geometry;
}

/**
 * Draws a point where nobody sees it, and shades its image, which is the ground: a shader is
 * compiled when it first draws, and again for targets of another kind.
 */
function compile(/** @type {ReturnType<typeof begin>} */ { renderer, material, screen }) {
  const image = drawingTarget();
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const camera = new PerspectiveCamera();
  const draw = (
    /** @type {import("../shared/vendor/three/three.module.min.js").Object3D} */ object,
    /** @type {typeof image | null} */ into,
  ) => {
    object.frustumCulled = false;
    renderer.setRenderTarget(into);
    renderer.render(object, camera);
  };
  draw(new Points(onePoint(), material), image);
  screen.uniforms.colors.value = image.texture;
  screen.uniforms.depths.value = image.depthTexture;
  screen.uniforms.ground.value.set(...groundOf(dark.matches));
  draw(sheetOf(screen), null);
  renderer.getContext().flush();
}

const canvas = document.querySelector("canvas#map");
try {
  if (canvas instanceof HTMLCanvasElement) compile(drawerOf(canvas));
} catch {
  // The page says what is missing, when it can.
}
