// Where the map is looked at from: from above or tilted, always orthographic. And how fingers move it.

const ABOVE = Math.PI / 2;
const TILTED = 0.62;

export class Camera {
  target = [0, 0, 0];
  pxPerM = 24;
  yaw = 0;
  pitch = ABOVE;

  get above() {
    return this.pitch === ABOVE;
  }

  tilt() {
    this.pitch = this.above ? TILTED : ABOVE;
    if (this.above) this.yaw = 0;
  }

  /** Rotation into the picture (right, up, toward the eye), by columns. */
  get turn() {
    const [c, s, u, f] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    return [c, -s * u, s * f, s, c * u, -c * f, 0, f, u];
  }

  /** Pixels of a place, from the middle of the picture, y down. */
  project([x, y, z]) {
    const t = this.turn;
    const [a, b, c] = [x - this.target[0], y - this.target[1], z - this.target[2]];
    return [(t[0] * a + t[3] * b + t[6] * c) * this.pxPerM, -(t[1] * a + t[4] * b + t[7] * c) * this.pxPerM];
  }

  pan(dx, dy) {
    const [c, s] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const right = -dx / this.pxPerM;
    const up = dy / this.pxPerM / Math.max(Math.sin(this.pitch), 0.3);
    this.target[0] += c * right - s * up;
    this.target[1] += s * right + c * up;
  }

  orbit(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(Math.max(this.pitch + dy * 0.006, 0.12), ABOVE - 0.01);
  }

  zoom(factor) {
    this.pxPerM = Math.min(Math.max(this.pxPerM * factor, 1), 400);
  }
}

/** One finger pans (or orbits in 3-D), two zoom and pan, a wheel zooms. */
export function moveByPointer(element, camera, { onMove, onHand }) {
  const held = new Map();
  const spread = () => {
    const [a, b] = [...held.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  element.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    const wide = held.size === 2 ? spread() : 0;
    const [dx, dy] = [event.clientX - before.x, event.clientY - before.y];
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (held.size === 2) {
      camera.zoom(spread() / Math.max(wide, 1));
      camera.pan(dx / 2, dy / 2);
    } else if (camera.above || event.shiftKey) camera.pan(dx, dy);
    else camera.orbit(dx, dy);
    if (Math.abs(dx) + Math.abs(dy) > 0) onHand(camera.above || held.size === 2);
    onMove();
  });
  for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, (event) => held.delete(event.pointerId));
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(-event.deltaY * 0.0015));
    onMove();
  }, { passive: false });
}
