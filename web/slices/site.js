// Puts the map on its control points: a trial, the decision, and the map made again.

import { putOnSite, remakeMap, takeOffSite, trySite } from "../shared/api.js";
import { attempt, html, nothing, render, within } from "../shared/dom.js";

/** @import {SiteTrial} from "../shared/http_types" */

/**
 * Fills the section below the residuals.
 * @param {HTMLElement} host
 * @param {string} id of the project
 */
export function siteSection(host, id) {
  const state = {
    trial: /** @type {SiteTrial | null} */ (null),
    busy: "",
    done: false,
  };
  const set = (/** @type {Partial<typeof state>} */ changes) => {
    Object.assign(state, changes);
    draw();
  };
  const crs = () => /** @type {HTMLInputElement} */ (within(host, "input")).value.trim();

  /**
   * @param {string} what shown meanwhile
   * @param {() => Promise<unknown>} work
   */
  async function run(what, work) {
    set({ busy: what });
    await attempt(within(host, ".error"), work);
    set({ busy: "" });
  }
  const tried = () => run("Trying…", async () => set({ trial: await trySite(id, crs()) }));
  /**
   * @param {string} what shown meanwhile
   * @param {() => Promise<unknown>} decide
   */
  const remade = (what, decide) =>
    run(what, async () => {
      await decide();
      await remakeMap(id);
      set({ done: true });
    });
  const put = () => remade("Putting the map on the points…", () => putOnSite(id, crs()));
  const takeOff = () => remade("Taking the map off the points…", () => takeOffSite(id));

  function outcome(/** @type {SiteTrial} */ { text, forbidden, unseen }) {
    return html`${forbidden.map((one) => html`<p class="bad">✕ ${one}</p>`)}
      ${unseen.length ? html`<p>Not measured in this map: ${unseen.join(", ")}.</p>` : nothing}
      <pre class="scroll" tabindex="0" aria-label="Residuals after the rigid fit">${text}</pre>
      ${
        forbidden.length
          ? nothing
          : html`<button type="button" ?disabled=${state.busy !== ""} @click=${put}>
              Put the map on these points
            </button>`
      }`;
  }

  function draw() {
    const { trial, busy, done } = state;
    render(
      html`<h3>Site coordinates</h3>
        <p class="quiet">
          Three or more control points place the map. They are tested first; check points only
          judge. The map is made again, and the places of points are measured in it again.
        </p>
        <label>EPSG <input size="12" placeholder="site grid" aria-label="EPSG code" /></label>
        <div class="buttons">
          <button type="button" ?disabled=${busy !== ""} @click=${tried}>Try</button>
          <button type="button" ?disabled=${busy !== ""} @click=${takeOff}>
            Take the map off control points
          </button>
        </div>
        <p class="quiet" role="status">${busy}</p>
        <p class="error" role="alert"></p>
        ${
          done
            ? html`<p>The map is made again: <a href="../">its progress</a>.</p>`
            : trial
              ? outcome(trial)
              : nothing
        }`,
      host,
    );
  }

  draw();
}
