// The dialog in which a map is approved: verdict, findings, figures, and the reason of the signer.

import { badge } from "../shared/badge.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { figures } from "../shared/figures.js";
import { fixedFindingList } from "../shared/finding_list.js";
import { isReason, verdictState } from "../shared/verdict.js";
import { t } from "../shared/texts.js";

/** @import {MapFacts} from "../shared/http_types" */

/** What the signature is about: the verdict with its reasons, and the figures. */
const about = (/** @type {MapFacts} */ map) =>
  html`<section class="signed-map" tabindex="0" aria-label=${t("what-is-approved")}>
    <p>${badge(verdictState(map.verdict))}</p>
    ${fixedFindingList(map)}
    <dl>
      ${figures(map.figures).map(
        ([text, value]) =>
          html`<div>
            <dt>${text}</dt>
            <dd>${value}</dd>
          </div>`,
      )}
    </dl>
  </section>`;

/**
 * The field for the reason, with why and how long one is needed.
 * @param {MapFacts} map
 * @param {number} conflicts
 */
function reasonField({ reason_needed, min_reason_characters }, conflicts) {
  const hint = t("reason-hint", { characters: String(min_reason_characters) });
  return html`<label
    ><span>${reason_needed || conflicts ? t("reason-required") : t("remark")}</span
    ><input name="why" maxlength="500" autocomplete="off" />${
      reason_needed ? html`<small>${hint}</small>` : nothing
    }</label
  >`;
}

/**
 * Asks for a reason and, if there are conflicts, for confirmation.
 * @param {MapFacts} map
 * @param {number} conflicts
 * @param {(why: string, confirmed: boolean) => Promise<boolean>} sign whether it is signed
 */
export function askToSign(map, conflicts, sign) {
  const dialog = openDialog(t("approve-map-title"), html`<form></form>`);
  dialog.classList.add("wide");
  const form = within(dialog, "form", HTMLFormElement);
  const list = about(map);
  const why = () => within(form, "[name=why]", HTMLInputElement).value;
  const isConfirmed = () => form.querySelector("[type=checkbox]:checked") !== null;
  const draw = ({ signing = false, allowed = false }) =>
    render(
      html`${list}
        <p>${t("signed-is")}</p>
        ${reasonField(map, conflicts)}
        ${
          conflicts
            ? html`<label class="check"
                ><input type="checkbox" /><span
                  >${t("sign-anyway", { count: conflicts })}</span
                ></label
              >`
            : nothing
        }
        ${messagePlace()}
        <div class="buttons">
          ${closeButton()}<button class="primary" ?disabled=${signing || !allowed}>
            ${signing ? t("signing") : t("sign")}
          </button>
        </div>`,
      form,
    );
  const allow = () => draw({ allowed: isReason(why(), map) });
  form.addEventListener("input", allow);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    draw({ signing: true });
    const done = await attempt(within(form, "p.error"), () => sign(why(), isConfirmed()));
    allow();
    if (done) dialog.close();
  });
  draw({ allowed: isReason("", map) });
}
