// The two rows of a surveyed point: residuals; what is stated of it, and what a person may do.

import { html, nothing, targetOf } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { HEADS, residualCells, roleText, statedText } from "./residual_table.js";

/**
 * @import {ControlSpec, Residual} from "../shared/http_types"
 * @typedef {(one: ControlSpec) => unknown} Action
 * @typedef {object} PointActions
 * @property {(action: () => unknown) => unknown} attempt
 * @property {(one: ControlSpec, role: ControlSpec["role"]) => unknown} setRole
 * @property {Action} go
 * @property {Action} pick
 * @property {Action} target
 * @property {Action} surface
 * @property {Action} drop
 */

const ROLES = ["check", "control"];

/**
 * @param {ControlSpec} one
 * @param {Residual | undefined} residual
 * @param {string} unused why what was measured does not count; empty = it does
 * @param {PointActions} actions
 */
export function pointRow(one, residual, unused, actions) {
  const name = one.id;
  const act = (
    /** @type {string} */ text,
    /** @type {string} */ label,
    /** @type {Action} */ action,
  ) =>
    html`<button
      type="button"
      class="go"
      aria-label=${label}
      @click=${() => actions.attempt(() => action(one))}
    >
      ${text}
    </button>`;
  const changed = (/** @type {Event} */ event) =>
    actions.attempt(() =>
      actions.setRole(one, /** @type {ControlSpec["role"]} */ (targetOf(event).value)),
    );
  return html`<tr class="point">
      <th scope="row">${name}</th>
      <td>
        <select aria-label=${t("role-of", { name })} @change=${changed}>
          ${ROLES.map(
            (role) =>
              html`<option value=${role} .selected=${role === one.role}>${roleText(role)}</option>`,
          )}
        </select>
      </td>
      ${residualCells(residual, unused)}
    </tr>
    <tr>
      <td colspan=${HEADS.length}>
        ${statedText(residual)}
        <span class="buttons"
          >${act(t("go"), t("go-to-point", { name }), actions.go)}
          ${act(t("here"), t("is-picked", { name }), actions.pick)}
          ${act(t("target"), t("is-target", { name }), actions.target)}
          ${act(t("surface"), t("on-surface", { name }), actions.surface)}
          ${
            residual || unused ? act(t("clear"), t("clear-point", { name }), actions.drop) : nothing
          }</span
        >
      </td>
    </tr>`;
}
