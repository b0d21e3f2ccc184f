// Dialogs of the review: the keys, and a loop closure between any two multiframes.

import { make } from "../shared/dom.js";
import { KEYS, seconds } from "./captions.js";
import { FIRST_CSS, SECOND_CSS } from "./draw.js";

export function open(title, ...children) {
  const dialog = make(
    "dialog",
    { "aria-labelledby": "dialog-title" },
    make("h2", { id: "dialog-title" }, title),
    ...children,
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

export function showKeys() {
  const rows = KEYS.map(([keys, text]) =>
    make("tr", {}, make("th", { scope: "row" }, make("kbd", {}, keys)), make("td", {}, text)),
  );
  const dialog = open(
    "Keys",
    make("table", {}, make("tbody", {}, ...rows)),
    make("button", { type: "button", onclick: () => dialog.close() }, "Close"),
  );
  dialog.classList.add("wide");
}

/** Asks for two multiframes by sliders or on the plan of the walk; `look([frame_i, frame_j])`. */
export function askForFrames(walk, chosen, look) {
  const most = walk.frames.length - 1;
  const nodeOf = (frame) =>
    Math.max(
      0,
      walk.frames.findIndex((one) => one >= frame),
    );
  const sliders = [0, 1].map((k) =>
    make("input", {
      type: "range",
      min: 0,
      max: most,
      value: chosen ? nodeOf(chosen[k]) : k ? most : 0,
    }),
  );
  const captions = sliders.map(() => make("output"));
  const message = make("p", { className: "error", role: "alert" });
  const plan = make("canvas", {
    width: 640,
    height: 400,
    className: "plan",
    ariaLabel: "The walk from above",
    role: "img",
  });
  let active = 0;
  const place = planner(walk, plan);
  const draw = () => {
    const nodes = sliders.map((one) => Number(one.value));
    nodes.forEach(
      (node, k) =>
        (captions[k].textContent = `${seconds(walk.t_s[node])}, multiframe ${walk.frames[node]}`),
    );
    place.draw(nodes);
  };
  sliders.forEach((one, k) => {
    one.addEventListener("input", draw);
    one.addEventListener("focus", () => (active = k));
  });
  plan.addEventListener("pointerdown", (event) => {
    sliders[active].value = place.nearest(event.offsetX, event.offsetY);
    active = 1 - active;
    draw();
  });
  const form = make(
    "form",
    {
      onsubmit(event) {
        event.preventDefault();
        const pair = sliders.map((one) => walk.frames[Number(one.value)]).sort((a, b) => a - b);
        if (pair[0] === pair[1]) return (message.textContent = "Both are the same multiframe");
        dialog.close();
        look(pair);
      },
    },
    plan,
    make("label", {}, make("span", {}, "First multiframe (blue)"), sliders[0], captions[0]),
    make("label", {}, make("span", {}, "Second multiframe (orange)"), sliders[1], captions[1]),
    message,
    make(
      "div",
      { className: "buttons" },
      make("button", { type: "button", onclick: () => dialog.close() }, "Cancel"),
      make("button", { className: "primary" }, "Look at this pair"),
    ),
  );
  const dialog = open("Add a loop closure", form);
  draw();
}

function planner(walk, canvas) {
  const xs = walk.xyz_m.map((p) => p[0]);
  const ys = walk.xyz_m.map((p) => p[1]);
  const [left, right, low, high] = [
    Math.min(...xs),
    Math.max(...xs),
    Math.min(...ys),
    Math.max(...ys),
  ];
  const scale = Math.min(600 / (right - left || 1), 360 / (high - low || 1));
  const at = (node) => [
    320 + (xs[node] - (left + right) / 2) * scale,
    200 - (ys[node] - (low + high) / 2) * scale,
  ];
  return {
    draw(nodes) {
      const context = canvas.getContext("2d");
      context.fillStyle = "#0f1418";
      context.fillRect(0, 0, 640, 400);
      context.strokeStyle = "#8fa0ae";
      context.lineWidth = 2;
      context.beginPath();
      xs.forEach((_, node) => context[node ? "lineTo" : "moveTo"](...at(node)));
      context.stroke();
      nodes.forEach((node, k) => {
        context.fillStyle = k ? SECOND_CSS : FIRST_CSS;
        context.beginPath();
        context.arc(...at(node), 9, 0, 7);
        context.fill();
      });
    },
    nearest(x, y) {
      const [u, v] = [(x * 640) / canvas.clientWidth, (y * 400) / canvas.clientHeight];
      const far = (node) => Math.hypot(at(node)[0] - u, at(node)[1] - v);
      return xs.reduce((best, _, node) => (far(node) < far(best) ? node : best), 0);
    },
  };
}
