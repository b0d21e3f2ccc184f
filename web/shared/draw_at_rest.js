// A scene that is drawn at the rate of the screen also when nothing in it changes, as viser's.

const AWAKE_MS = 1500; // a camera that was let go comes to rest within this time
const AT_REST_MS = 250;
const INPUT = ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "keyup", "resize"];

/**
 * From now on frames are drawn at full rate for a while after input and after messages of workers,
 * and four times a second at other times: a map that only lies there costs next to nothing.
 */
export function drawLessAtRest(scope = window) {
  const request = scope.requestAnimationFrame.bind(scope);
  const cancel = scope.cancelAnimationFrame.bind(scope);
  const waiting = new Map();
  let last = 0;
  let awakeUntil = 0;

  function begin(/** @type {number} */ id) {
    const one = waiting.get(id);
    one.timer = undefined;
    one.frame = request((time) => {
      waiting.delete(id);
      one.draw(time);
    });
  }

  function wake() {
    awakeUntil = scope.performance.now() + AWAKE_MS;
    for (const [id, one] of waiting)
      if (one.timer !== undefined) {
        scope.clearTimeout(one.timer);
        begin(id);
      }
  }

  scope.requestAnimationFrame = (draw) => {
    const id = ++last;
    waiting.set(id, { draw });
    if (scope.performance.now() < awakeUntil) begin(id);
    else waiting.get(id).timer = scope.setTimeout(begin, AT_REST_MS, id);
    return id;
  };
  scope.cancelAnimationFrame = (id) => {
    const one = waiting.get(id);
    waiting.delete(id);
    if (one?.timer !== undefined) scope.clearTimeout(one.timer);
    else if (one) cancel(one.frame);
  };
  const Waking = class extends scope.Worker {
    /**
     * @param {string | URL} url
     * @param {WorkerOptions} options
     */
    constructor(url, options) {
      super(url, options);
      this.addEventListener("message", wake);
    }
  };
  scope.Worker = /** @type {typeof Worker} */ (Waking);
  for (const kind of INPUT) scope.addEventListener(kind, wake, { capture: true, passive: true });
  wake();
}
