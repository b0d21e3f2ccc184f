// Lays a reference on the map: by three pairs of points, or moved by hand; then ICP.

import { alignReference, readAlignPoints } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import "../review/view.js";
import { inFrames, poseInMap, unpacked } from "./align_math.js";

const UPRIGHT = [0, 0, 0, 1];

const check = (text, checked = true) => {
  const input = make("input", { type: "checkbox", checked });
  return { input, label: make("label", { className: "check" }, input, make("span", {}, text)) };
};

/** Opens the dialog for a reference; `changed()` after every new alignment. */
export async function openAlignment(id, one, changed) {
  const view = make("pair-view", {});
  [view.dataset.first, view.dataset.second] = ["map", "reference"];
  const message = make("p", { className: "error", role: "alert" });
  const result = make("p", { role: "status" }, `Alignment: ${one.alignment}`);
  const level = check("Both are level: heights come from the floors, not from the pairs");
  const refine = check("Then refine by ICP");
  let points = null;

  async function show() {
    points = await readAlignPoints(id, one.id);
    const poses = { odometry: points.pose, predicted: points.pose, after: points.pose };
    const clouds = { i: unpacked(points.p_map), j: unpacked(points.p_reference) };
    const drawn = view.set(clouds, poses, UPRIGHT);
    view.show("cut");
    await drawn;
  }

  async function align(how) {
    const found = await alignReference(id, one.id, how);
    await show();
    result.textContent = `Alignment: ${found.alignment}. ${found.fit}`;
    result.className = found.fit.startsWith("✕") ? "bad" : "";
    undo.disabled = !found.can_undo;
    await changed();
  }

  const button = (text, action, more = {}) => {
    const made = make("button", { type: "button", ...more }, text);
    made.addEventListener("click", async () => {
      made.disabled = true;
      await attempt(message, action);
      made.disabled = false;
    });
    return made;
  };
  const pick = button(
    "Pick three pairs",
    () =>
      view.pick((picked) =>
        attempt(message, () =>
          align({
            how: "pairs",
            ...inFrames(picked, points),
            level: level.input.checked,
            refine: refine.input.checked,
          }),
        ),
      ),
    { className: "primary" },
  );
  const byHand = button("Refine by ICP from here", () =>
    align({ how: "icp", pose: poseInMap(view.pose, points) }),
  );
  const undo = button("Undo alignment", () => align({ how: "undo" }));
  undo.disabled = !one.can_undo;
  const dialog = make(
    "dialog",
    { className: "aligning", ariaLabel: `Align ${one.name} with the map` },
    make("h2", {}, `Align ${one.name} with the map`),
    make(
      "p",
      { className: "quiet" },
      "Pick the same three points in the map (blue) and the reference (orange) by turns, as ",
      "corners of walls far from each other. Or move the reference by its handle and ring ",
      "(Above), then refine.",
    ),
    view,
    make("div", { className: "buttons" }, pick, byHand, undo),
    make("div", { className: "buttons" }, level.label, refine.label),
    message,
    result,
    make("form", { method: "dialog" }, make("button", {}, "Close")),
  );
  dialog.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !view.isPicking) return;
    event.preventDefault(); // the first ends picking, the second closes
    view.stopPicking();
  });
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  await attempt(message, show);
}
