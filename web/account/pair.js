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

const CLAIM_EVERY_MS = 2000;
const AGAIN = "again"; // the session has ended
const token = location.hash.slice(1);
forgetFragment();
const form = byId("ask", HTMLFormElement);

async function useInvitation() {
  byId("ask").hidden = true;
  byId("words").textContent = "Signing in…";
  if (await attempt(byId("message"), () => redeemInvitation(token)))
    return location.replace(liveUrl);
  byId("words").textContent = "Make a new QR code on the laptop, or sign in with a code";
  byId("ask").hidden = false;
}

async function ask(/** @type {SubmitEvent} */ event) {
  event.preventDefault();
  const asked = await attempt(byId("message"), () => requestPairing(fields(form).phone.value));
  if (!asked) return;
  byId("ask").hidden = byId("else").hidden = true;
  byId("words").textContent =
    "On a computer that is signed in, open the page Phone and enter this code";
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
  byId("left").textContent =
    `Waiting, ${Math.floor(left / 60)}:${String(left % 60).padStart(2, "0")} left`;
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
const ended =
  token === AGAIN ? "The session of this phone has ended; a running capture goes on. " : "";
if (await isIn()) location.replace(liveUrl);
else if (token && !ended) await useInvitation();
else
  byId("words").textContent =
    `${ended}Scan the QR code on the laptop (page Phone), or sign in with a code`;
