// <recording-look>: the contents of a recording as a list.

import { createRig, lookAt, rigUrl } from "../shared/api.js";
import { asError, html, nothing, render, showError, within } from "../shared/dom.js";
import { bytes, count, seconds } from "../shared/format.js";
import { decimal, t } from "../shared/texts.js";

/** @import {RecordingSummary, SensorSummary} from "../shared/http_types" */

export class RecordingLook extends HTMLElement {
  #asked = 0;

  connectedCallback() {
    this.setAttribute("role", "status");
    this.hidden = true;
  }

  /** The summary of a recording; null if unreadable or if another was requested meanwhile. */
  async look(/** @type {string} */ path) {
    const mine = (this.#asked += 1);
    this.hidden = !path;
    if (!path) return null;
    render(html`<p class="quiet">${t("recording-reading")}</p>`, this);
    try {
      const found = await lookAt(path);
      if (mine !== this.#asked) return null;
      render(html`${summary(found)}${this.#rigOffer(found)}`, this);
      return found;
    } catch (error) {
      if (mine === this.#asked) this.#refuse(path, error);
      return null;
    }
  }

  /** A button that makes a rig of the sensors, where the recording does not say their mounts. */
  #rigOffer(/** @type {RecordingSummary} */ found) {
    if (!found.first_rig) return nothing;
    return html`<p class="rig-offer">
      <button type="button" @click=${() => this.#makeRig(found)}>${t("recording-make-rig")}</button>
      <span class="made"></span><span class="error"></span>
    </p>`;
  }

  /** Stores the rig under the name of the recording, and offers its page to fill in the mounts. */
  async #makeRig(/** @type {RecordingSummary} */ { first_rig: toml, project }) {
    const id = project.replace(/[^A-Za-z0-9._-]+/g, "-").replace(/^[^A-Za-z0-9]+/, "") || "rig";
    const [button, place] = [within(this, ".rig-offer button"), within(this, ".rig-offer .made")];
    try {
      const saved = await createRig({ id: id.slice(0, 64), toml, note: "made of a recording" });
      render(
        html`${t("figure-rig")}
          <a href=${rigUrl(saved.id)} target="_blank">${saved.id}</a> ${t("recording-rig-made")}
          <strong>${t("recording-mounts")}</strong> ${t("recording-choose")}`,
        place,
      );
      button.hidden = true;
      this.dispatchEvent(new CustomEvent("rig"));
    } catch (error) {
      showError(within(this, ".rig-offer .error"), error);
    }
  }

  /**
   * The reason, and a button for each recording in the folder.
   * @param {string} folder
   * @param {unknown} error
   */
  #refuse(folder, error) {
    const { candidates = [] } = asError(error);
    const choose = (/** @type {string} */ path) =>
      this.dispatchEvent(new CustomEvent("pick", { detail: path }));
    const label = (/** @type {string} */ path) =>
      path.startsWith(`${folder}/`) ? path.slice(folder.length + 1) : path;
    render(
      html`<p class="error"></p>
        <div class="buttons">
          ${candidates.map(
            (path) =>
              html`<button type="button" @click=${() => choose(path)}>
                ${t("recording-use", { path: label(path) })}
              </button>`,
          )}
        </div>`,
      this,
    );
    showError(within(this, ".error"), error);
  }
}

function summary(/** @type {RecordingSummary} */ found) {
  const { kind, bytes: size, seconds: duration, warnings } = found;
  const about = found.estimated ? t("recording-about") : "";
  const facts = [kind, bytes(size), duration > 0 ? `${about}${seconds(duration)}` : ""];
  return html`<p><strong>${facts.filter(Boolean).join(" · ")}</strong></p>
    <dl class="found">
      ${rowsOf(found, about).map(
        ([term, text]) =>
          html`<dt>${term}</dt>
            <dd>${text}</dd>`,
      )}
    </dl>
    ${
      warnings.length
        ? html`<p class="warn">▲ ${t("recording-warnings")}</p>
            <ul>
              ${warnings.map((text) => html`<li>${text}</li>`)}
            </ul>`
        : nothing
    }`;
}

/**
 * What is in it: a term and a text each.
 * @param {RecordingSummary} found
 * @param {string} about in front of what is estimated
 * @returns {Array<[string, string]>}
 */
function rowsOf({ sensors, samples, rig, imu, gnss, derived, missing }, about) {
  const sensor = (/** @type {SensorSummary} */ one) => {
    const rate = one.rate_hz === null ? "" : `, ${decimal(one.rate_hz, 1)}/s`;
    return `${one.model} (${one.label}): ${about}${count(one.count)} ${one.content}${rate}`;
  };
  const beside = (/** @type {string} */ path) =>
    t("recording-beside", { file: path.split("/").at(-1) ?? "" });
  /** @type {Array<[string, string[]]>} */
  const all = [
    ["LiDAR", sensors.map(sensor)],
    [t("recording-samples"), samples],
    [t("figure-rig"), rig ? [beside(rig)] : []],
    ["IMU", imu ? [beside(imu)] : []],
    ["GNSS", gnss ? [beside(gnss)] : []],
    [t("recording-derived"), derived],
    [t("recording-missing"), missing],
  ];
  return all.flatMap(([term, texts]) =>
    texts.map((text) => /** @type {[string, string]} */ ([term, text])),
  );
}

customElements.define("recording-look", RecordingLook);
