// The phone's side of pairing: uses the one-time link, or shows six digits and waits for approval.

import { forgetFragment } from "../shared/address.js";
import {
  requestPairing,
  claimPairing,
  isSignedIn,
  liveUrl,
  redeemInvitation,
} from "../shared/api.js";
import { asError, attempt, byId, fields, onSubmit, say } from "../shared/dom.js";
import "../shared/language_choice.js";
import { t } from "../shared/texts.js";

const CLAIM_EVERY_MS = 2000;
const AGAIN = "again"; // the session has ended
const token = location.hash.slice(1);
forgetFragment();
const form = byId("ask", HTMLFormElement);

async function useInvitation() {
  byId("ask").hidden = true;
  byId("words").textContent = t("signing-in");
  if (await attempt(byId("message"), () => redeemInvitation(token)))
    return location.replace(liveUrl);
  byId("words").textContent = t("pair-new-code");
  byId("ask").hidden = false;
}

async function ask(/** @type {SubmitEvent} */ event) {
  event.preventDefault();
  const asked = await attempt(byId("message"), () => requestPairing(fields(form).phone.value));
  if (!asked) return;
  byId("ask").hidden = byId("else").hidden = true;
  byId("words").textContent = t("pair-enter");
  byId("digits").textContent = `${asked.code.slice(0, 3)} ${asked.code.slice(3)}`;
  byId("digits").hidden = byId("left").hidden = false;
  await wait(asked, performance.now() + 1000 * asked.seconds);
}

/**
 * @param {{token: string, seconds: number}} asked
 * @param {number} untilMs
 */
async function wait(asked, untilMs) {
  const left = Math.max(0, Math.round((untilMs - performance.now()) / 1000));
  const time = `${Math.floor(left / 60)}:${String(left % 60).padStart(2, "0")}`;
  byId("left").textContent = t("pair-waiting", { time });
  try {
    if (await claimPairing(asked.token)) return location.replace(liveUrl);
  } catch (error) {
    const { status, message } = asError(error);
    if (status !== 0) return over(message); // without a link: try again
  }
  setTimeout(wait, CLAIM_EVERY_MS, asked, untilMs);
}

function over(/** @type {string} */ text) {
  byId("digits").hidden = byId("left").hidden = true;
  byId("words").textContent = "";
  say(byId("message"), text);
  byId("ask").hidden = byId("else").hidden = false;
}

/** Whether this browser is signed in; false without a link, so that the page can be used. */
const isIn = () => isSignedIn().catch(() => false);

onSubmit(form, ask);
const ended = token === AGAIN ? `${t("pair-ended")} ` : "";
if (await isIn()) location.replace(liveUrl);
else if (token && !ended) await useInvitation();
else byId("words").textContent = `${ended}${t("pair-scan")}`;
