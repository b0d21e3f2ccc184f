// Lays a reference on the map: by three pairs of points, or moved by hand; then ICP.

import { alignReference, readAlignPoints } from "../shared/api.js";
import { openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { PairView } from "../review/view.js";
import { inFrames, poseInMap, unpacked } from "./align_math.js";

/** @import {AlignPoints, AlignRequest, ListedReference} from "../shared/http_types" */

const UPRIGHT = [0, 0, 0, 1];

/**
 * Opens the dialog for a reference; `changed()` after every new alignment.
 * @param {string} id of the project
 * @param {ListedReference} reference
 * @param {() => Promise<void>} changed
 */
export async function openAlignment(id, reference, changed) {
  /** @type {{points: AlignPoints | null}} */
  const state = { points: null };
  const dialog = openDialog(
    t("align-with", { reference: reference.name }),
    html`<p class="quiet">${t("align-help")}</p>
      <pair-view data-first=${t("name-map")} data-second=${t("name-reference")}></pair-view>
      <div class="buttons">
        <button type="button" class="primary" @click=${() => pick()}>${t("pick-pairs")}</button
        ><button type="button" @click=${(/** @type {Event} */ event) => byHand(event)}>
          ${t("refine-icp")}</button
        ><button
          type="button"
          class="undo"
          ?disabled=${!reference.can_undo}
          @click=${(/** @type {Event} */ event) => act(event, () => align({ how: "undo" }))}
        >
          ${t("undo-alignment")}
        </button>
      </div>
      <div class="buttons">
        <label class="check"
          ><input type="checkbox" name="level" checked /><span>${t("both-level")}</span></label
        ><label class="check"
          ><input type="checkbox" name="refine" checked /><span>${t("then-icp")}</span></label
        >
      </div>
      ${messagePlace()}
      <p class="result" role="status">${t("alignment-is", { alignment: reference.alignment })}</p>
      <form method="dialog"><button>${t("close")}</button></form>`,
  );
  dialog.classList.add("aligning");
  const view = within(dialog, "pair-view", PairView);
  const message = within(dialog, ".error");
  const isChecked = (/** @type {string} */ name) =>
    within(dialog, `[name=${name}]`, HTMLInputElement).checked;

  async function show() {
    const points = await readAlignPoints(id, reference.id);
    state.points = points;
    const poses = { odometry: points.pose, predicted: points.pose, after: points.pose };
    const clouds = { i: unpacked(points.p_map), j: unpacked(points.p_reference) };
    const drawn = view.set(clouds, poses, UPRIGHT);
    view.show("cut");
    await drawn;
  }

  async function align(/** @type {AlignRequest} */ how) {
    const found = await alignReference(id, reference.id, how);
    await show();
    const result = within(dialog, ".result");
    result.textContent = `${t("alignment-is", { alignment: found.alignment })}. ${found.fit}`;
    result.classList.toggle("bad", found.fits === false);
    within(dialog, ".undo", HTMLButtonElement).disabled = !found.can_undo;
    await changed();
  }

  /**
   * Runs the action of a button, which can be used again afterwards.
   * @param {Event} event
   * @param {() => Promise<void>} action
   */
  async function act(event, action) {
    const button = /** @type {HTMLButtonElement} */ (event.currentTarget);
    button.disabled = true;
    const done = await attempt(message, async () => (await action(), true));
    if (!done || !button.matches(".undo")) button.disabled = false;
  }

  const pick = () =>
    view.pick((picked) =>
      attempt(message, async () => {
        const { points } = state;
        if (!points) return;
        const [level, refine] = [isChecked("level"), isChecked("refine")];
        await align({ how: "pairs", ...inFrames(picked, points), level, refine });
      }),
    );
  const byHand = (/** @type {Event} */ event) =>
    act(event, async () => {
      if (state.points) await align({ how: "icp", pose: poseInMap(view.pose, state.points) });
    });
  dialog.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !view.isPicking) return;
    event.preventDefault(); // the first ends picking, the second closes
    view.stopPicking();
  });
  await attempt(message, show);
}
