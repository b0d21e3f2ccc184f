// The laptop's side of pairing: a QR code for one phone, or the digits a phone shows.

import { wholeUrl } from "../shared/address.js";
import { approvePhone, invitePhone, readPairing } from "../shared/api.js";
import { attempt, byId, fields, html, onSubmit, render, within } from "../shared/dom.js";
import "../shared/page_head.js";
import { t } from "../shared/texts.js";

/** @import {Role} from "../shared/http_types" */

/** @type {Record<string, string>} */
const MAY = { operator: t("phone-operator"), viewer: t("phone-viewer") };
/** @type {{timer: ReturnType<typeof setInterval> | undefined}} */
const shown = { timer: undefined };

const form = byId("approve", HTMLFormElement);

const role = () =>
  /** @type {Role} */ (within(document, "input[name=role]:checked", HTMLInputElement).value);

function showRoles(/** @type {string[]} */ roles) {
  /**
   * @param {string} value
   * @param {number} k
   */
  const one = (value, k) => {
    const radio = html`<input
      type="radio"
      name="role"
      value=${value}
      .checked=${k === 0}
      @change=${chose}
    />`;
    return html`<label class="check"
      >${radio}<span><b>${t(`role-${value}`)}</b>: ${MAY[value]}</span></label
    >`;
  };
  render(roles.map(one), byId("roles"));
  chose();
}

/** Hides the code: it is for the role that was selected before. */
function chose() {
  hideCode();
  byId("approve-phone").textContent = t("approve-as", { role: t(`role-${role()}`) });
}

async function invite() {
  const invitation = await attempt(byId("message"), () => invitePhone(role()));
  if (!invitation) return;
  const show = () => {
    const link = invitation.links[byId("host", HTMLSelectElement).selectedIndex];
    if (!link) return;
    byId("qr", HTMLImageElement).src = link.qr;
    byId("pair-url").textContent = link.url.split("#")[0];
  };
  render(
    invitation.links.map(({ host }) => html`<option>${host}</option>`),
    byId("host"),
  );
  byId("host").onchange = show;
  byId("address").hidden = invitation.links.length < 2;
  byId("shown").hidden = false;
  byId("invite").textContent = t("show-new-code");
  show();
  countDown(performance.now() + 1000 * invitation.seconds, invitation.role);
}

/**
 * @param {number} untilMs
 * @param {string} given
 */
function countDown(untilMs, given) {
  clearInterval(shown.timer);
  const tick = () => {
    const left = Math.round((untilMs - performance.now()) / 1000);
    byId("left").textContent = t("qr-left", { role: t(`role-${given}`), seconds: String(left) });
    if (left <= 0) hideCode();
  };
  shown.timer = setInterval(tick, 1000);
  tick();
}

function hideCode() {
  clearInterval(shown.timer);
  byId("shown").hidden = true;
  byId("qr").removeAttribute("src");
  byId("invite").textContent = t("show-qr");
}

async function approve(/** @type {SubmitEvent} */ event) {
  event.preventDefault();
  byId("approved").textContent = "";
  const code = fields(form).code.value.replace(/\s/g, "");
  const phone = await attempt(byId("approve-message"), () => approvePhone(code, role()));
  if (!phone) return;
  form.reset();
  const { name, address } = phone;
  const done = t("phone-signed-in", { name, address, role: t(`role-${role()}`) });
  byId("approved").textContent = `✓ ${done}`;
}

byId("invite").addEventListener("click", invite);
onSubmit(form, approve);
const pairing = await attempt(byId("message"), readPairing);
if (pairing) {
  byId("without").hidden = pairing.login;
  byId("ways").hidden = !pairing.login;
  byId("fingerprint").textContent = pairing.fingerprint;
  byId("pair-url").textContent = wholeUrl("/pair");
  showRoles(pairing.roles);
}
