// The walk and the nodes of the pose graph as objects over the map.

import {
  BufferAttribute,
  BufferGeometry,
  Line,
  LineBasicMaterial,
  Points,
  PointsMaterial,
} from "../shared/vendor/three/three.module.min.js";

/**
 * A line along the walk, and a dot at each node.
 * @param {number[][]} walk
 * @param {number[][]} nodes
 */
export function layersOf(walk, nodes) {
  const flat = (/** @type {number[][]} */ points) => {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points.flat()), 3));
    return geometry;
  };
  const over = { depthTest: false, depthWrite: false, transparent: true };
  return {
    walk: new Line(flat(walk), new LineBasicMaterial({ color: "#ff8a1f", ...over })),
    nodes: new Points(
      flat(nodes),
      new PointsMaterial({ color: "#2f9bff", size: 6, sizeAttenuation: false, ...over }),
    ),
  };
}
