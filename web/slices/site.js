// Puts the map on its control points: a trial, the decision, and the map made again.

import { putOnSite, remakeMap, takeOffSite, trySite } from "../shared/api.js";
import { attempt, html, nothing, render, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { triedTable } from "./residual_table.js";

/** @import {SiteTrial} from "../shared/http_types" */

/** As the server names the system that control points alone define. */
const SITE_GRID = "site grid";

/**
 * Fills the section below the residuals.
 * @param {HTMLElement} host
 * @param {string} id of the project
 * @param {() => Promise<unknown>} readPoints as a decision left them
 */
export function siteSection(host, id, readPoints) {
  const state = {
    trial: /** @type {SiteTrial | null} */ (null),
    tried: "", // the system of the trial
    busy: "",
    done: false,
  };
  const set = (/** @type {Partial<typeof state>} */ changes) => {
    Object.assign(state, changes);
    draw();
  };
  const input = () => /** @type {HTMLInputElement} */ (within(host, "input"));
  const crs = () => input().value.trim();

  /**
   * @param {string} what shown meanwhile
   * @param {() => Promise<unknown>} work
   */
  async function run(what, work) {
    set({ busy: what });
    await attempt(within(host, ".error"), work);
    set({ busy: "" });
  }
  const tried = () =>
    run(t("trying"), async () => {
      set({ trial: null, done: false, tried: crs() });
      set({ trial: await trySite(id, state.tried) });
    });
  /**
   * @param {string} what shown meanwhile
   * @param {() => Promise<unknown>} decide
   */
  const remade = (what, decide) =>
    run(what, async () => {
      await decide();
      await readPoints();
      await remakeMap(id);
      set({ done: true });
    });
  const put = () => remade(t("putting"), () => putOnSite(id, state.tried));
  const takeOff = () => remade(t("taking-off"), () => takeOffSite(id));

  function decision() {
    const system = state.tried || t("site-grid");
    return html`<p>${t("what-put-does", { system })}</p>
      <button type="button" class="primary" ?disabled=${state.busy !== ""} @click=${put}>
        ${t("put-on-points")}
      </button>`;
  }

  function outcome(/** @type {SiteTrial} */ { points, remarks, text, forbidden, unseen }) {
    return html`${
        forbidden.length
          ? forbidden.map((one) => html`<p class="bad">✕ ${one}</p>`)
          : html`<p class="good">✓ ${t("points-agree")}</p>`
      }
      ${
        unseen.length
          ? html`<p>${t("not-measured-here", { names: unseen.join(", ") })}</p>`
          : nothing
      }
      ${triedTable(points)} ${forbidden.length ? nothing : decision()}
      ${
        forbidden.length // of points that contradict each other nothing more is said
          ? nothing
          : html`<ul class="quiet statements">
              ${remarks.map((one) => html`<li>${one}</li>`)}
            </ul>`
      }
      <details class="folded">
        <summary>${t("all-figures")}</summary>
        <pre class="scroll" tabindex="0" aria-label=${t("residuals-after-fit")}>${text}</pre>
      </details>`;
  }

  function draw() {
    const { trial, busy, done } = state;
    const waits = busy !== "";
    render(
      html`<h2>${t("site-coordinates")}</h2>
        <p class="quiet">${t("site-is")}</p>
        <label
          ><span>${t("epsg-code")}</span><input size="12" placeholder=${t("site-grid")}
        /></label>
        <div class="buttons">
          <button type="button" ?disabled=${waits} @click=${tried}>${t("try")}</button>
          <button type="button" ?disabled=${waits} @click=${takeOff}>${t("take-off")}</button>
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
  return {
    /** Fills in the system of a survey that is known to be in it. */
    suggest: (/** @type {string} */ system) => {
      if (system && system !== SITE_GRID && !crs()) input().value = system;
    },
  };
}
