// The laptop's side of pairing: a QR code for one phone, or the digits a phone shows.

import { wholeUrl } from "../shared/address.js";
import { approvePhone, invitePhone, readPairing } from "../shared/api.js";
import { attempt, byId, fields, make, onSubmit } from "../shared/dom.js";
import "../shared/page_head.js";

const MAY = { operator: "look, and start, mark and stop", viewer: "look only" };
let timer = null;

const role = () =>
  /** @type {HTMLInputElement} */ (document.querySelector("input[name=role]:checked")).value;

function showRoles(roles) {
  const one = (value, k) => {
    const radio = make("input", {
      type: "radio",
      name: "role",
      value,
      checked: k === 0,
      onchange: chose,
    });
    return make(
      "label",
      { className: "check" },
      radio,
      make("span", {}, make("b", {}, value), `: ${MAY[value]}`),
    );
  };
  byId("roles").append(...roles.map(one));
  chose();
}

/** Hides the code: it is for the role that was selected before. */
function chose() {
  hideCode();
  byId("approve-phone").textContent = `Approve as ${role()}`;
}

async function invite() {
  const invitation = await attempt(byId("message"), () => invitePhone(role()));
  if (!invitation) return;
  const show = () => {
    const link = invitation.links[byId("host", HTMLSelectElement).selectedIndex];
    byId("qr", HTMLImageElement).src = link.qr;
    byId("pair-url").textContent = link.url.split("#")[0];
  };
  byId("host").replaceChildren(...invitation.links.map(({ host }) => make("option", {}, host)));
  byId("host").onchange = show;
  byId("address").hidden = invitation.links.length < 2;
  byId("shown").hidden = false;
  byId("invite").textContent = "Show a new code";
  show();
  countDown(performance.now() + 1000 * invitation.seconds, invitation.role);
}

function countDown(untilMs, given) {
  clearInterval(timer);
  const tick = () => {
    const left = Math.round((untilMs - performance.now()) / 1000);
    byId("left").textContent = `For one phone, as ${given}, ${left} s left`;
    if (left <= 0) hideCode();
  };
  timer = setInterval(tick, 1000);
  tick();
}

function hideCode() {
  clearInterval(timer);
  byId("shown").hidden = true;
  byId("qr").removeAttribute("src");
  byId("invite").textContent = "Show QR code";
}

async function approve(event) {
  event.preventDefault();
  byId("approved").textContent = "";
  const code = fields(event.target).code.value.replace(/\s/g, "");
  const phone = await attempt(byId("approve-message"), () => approvePhone(code, role()));
  if (!phone) return;
  event.target.reset();
  byId("approved").textContent = `✓ ${phone.name} at ${phone.address} is signed in as ${role()}`;
}

byId("invite").addEventListener("click", invite);
onSubmit(byId("approve"), approve);
const pairing = await attempt(byId("message"), readPairing);
if (pairing) {
  byId("without").hidden = pairing.login;
  byId("ways").hidden = !pairing.login;
  byId("fingerprint").textContent = pairing.fingerprint;
  byId("pair-url").textContent = wholeUrl("/pair");
  showRoles(pairing.roles);
}
