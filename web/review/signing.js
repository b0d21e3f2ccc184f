// The dialog in which a map is approved: verdict, findings, figures, and the reason of the signer.

import { badge } from "../shared/badge.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { html, messagePlace, nothing, render, succeeds, within } from "../shared/dom.js";
import { figures } from "../shared/figures.js";
import { fixedFindingList } from "../shared/finding_list.js";
import { isReason, verdictState } from "../shared/verdict.js";
import { t } from "../shared/texts.js";

/** @import {Approve, MapFacts} from "../shared/http_types" */

/**
 * What a signature would be about: the map as the page has shown it.
 * @typedef {object} ShownMap
 * @property {MapFacts} map
 * @property {number} after_seq the last decision it was shown with
 * @property {string} graph the graph it was shown with
 * @property {number} conflicts
 */

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

/** The map that a page shows; null = there is none. */
export function shownMap(/** @type {import("./state.js").ReviewState} */ { server, effect }) {
  if (!server?.map) return null;
  const { seq: after_seq, graph, map } = server;
  return { after_seq, graph, map, conflicts: effect?.conflicts.length ?? 0 };
}

/**
 * Asks for a reason and, if there are conflicts, for confirmation. After a refusal the map is read
 * again: it may have been changed since it was shown.
 * @param {object} page
 * @param {() => ShownMap | null} page.shown
 * @param {() => Promise<void>} page.read reads what the page shows again
 * @param {(approval: Approve) => Promise<void>} page.sign
 */
export function askToSign(page) {
  const first = page.shown();
  if (!first) return;
  let shown = first;
  const dialog = openDialog(t("approve-map-title"), html`<form></form>`);
  dialog.classList.add("wide");
  const form = within(dialog, "form", HTMLFormElement);
  const why = () => within(form, "[name=why]", HTMLInputElement).value;
  const isConfirmed = () => form.querySelector("[type=checkbox]:checked") !== null;
  const draw = ({ signing = false, allowed = false }) => {
    const { map, conflicts } = shown;
    render(
      html`${about(map)}
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
  };
  const allow = () => draw({ allowed: isReason(why(), shown.map) });
  const signShown = async () => {
    const { after_seq, graph } = shown;
    try {
      await page.sign({ why: why(), confirmed: isConfirmed(), after_seq, graph });
    } catch (error) {
      await page.read();
      shown = page.shown() ?? shown;
      throw error;
    }
  };
  form.addEventListener("input", allow);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    draw({ signing: true });
    const done = await succeeds(within(form, "p.error"), signShown);
    allow();
    if (done) dialog.close();
  });
  draw({ allowed: isReason("", shown.map) });
}
