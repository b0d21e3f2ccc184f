// Puts the map on its control points: a trial, the decision, and the map made again.

import { putOnSite, remakeMap, takeOffSite, trySite } from "../shared/api.js";
import { attempt, html, nothing, render, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";

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
  const tried = () => run(t("trying"), async () => set({ trial: await trySite(id, crs()) }));
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
  const put = () => remade(t("putting"), () => putOnSite(id, crs()));
  const takeOff = () => remade(t("taking-off"), () => takeOffSite(id));

  function outcome(/** @type {SiteTrial} */ { text, forbidden, unseen }) {
    return html`${forbidden.map((one) => html`<p class="bad">✕ ${one}</p>`)}
      ${
        unseen.length
          ? html`<p>${t("not-measured-here", { names: unseen.join(", ") })}</p>`
          : nothing
      }
      <pre class="scroll" tabindex="0" aria-label=${t("residuals-after-fit")}>${text}</pre>
      ${
        forbidden.length
          ? nothing
          : html`<button type="button" ?disabled=${state.busy !== ""} @click=${put}>
              ${t("put-on-points")}
            </button>`
      }`;
  }

  function draw() {
    const { trial, busy, done } = state;
    render(
      html`<h2>${t("site-coordinates")}</h2>
        <p class="quiet">${t("site-is")}</p>
        <label
          >EPSG <input size="12" placeholder=${t("site-grid")} aria-label=${t("epsg-code")}
        /></label>
        <div class="buttons">
          <button type="button" ?disabled=${busy !== ""} @click=${tried}>${t("try")}</button>
          <button type="button" ?disabled=${busy !== ""} @click=${takeOff}>${t("take-off")}</button>
        </div>
        <p class="quiet" role="status">${busy}</p>
        <p class="error" role="alert"></p>
        ${
          done
            ? html`<p>${t("map-remade")} <a href="../">${t("its-progress")}</a>.</p>`
            : trial
              ? outcome(trial)
              : nothing
        }`,
      host,
    );
  }

  draw();
}
