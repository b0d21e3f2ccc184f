// The login, and the first admin of a server without accounts.

import { forgetFragment, pathInside, wholeUrl } from "../shared/address.js";
import { isSignedIn, setUp, signIn } from "../shared/api.js";
import { asError, byId, fields, onSubmit, targetOf } from "../shared/dom.js";
import "../shared/language_choice.js";
import { t } from "../shared/texts.js";

const form = byId("login", HTMLFormElement);
const controls = fields(form);
const go = byId("go", HTMLButtonElement);
const given = new URLSearchParams(location.hash.slice(1));
const setup = given.get("setup");
forgetFragment();

/** Where to go after the login: a page of this server and nothing else. */
const next = () => wholeUrl(pathInside(given.get("next") ?? "/"));

function offerSetup() {
  document.title = t("first-admin-page");
  byId("title").textContent = t("first-admin");
  byId("words").textContent = t("first-admin-why");
  go.textContent = t("first-admin-go");
  byId("words").hidden = byId("hint").hidden = false;
  controls.password.autocomplete = "new-password";
  controls.password.minLength = 12;
}

async function submit(/** @type {SubmitEvent} */ event) {
  event.preventDefault();
  const message = byId("message");
  message.textContent = "";
  go.disabled = true;
  try {
    const [name, password] = [controls.name.value, controls.password.value];
    await (setup ? setUp(setup, name, password) : signIn(name, password));
    location.replace(next());
  } catch (error) {
    message.textContent = asError(error).message;
    go.disabled = false;
    controls.password.select();
  }
}

onSubmit(form, submit);
byId("show").addEventListener("change", (event) => {
  controls.password.type = targetOf(event).checked ? "text" : "password";
});
if (setup) offerSetup();
// Before any wait: a password that is being typed would go on in the field of the name.
if (!form.contains(document.activeElement)) controls.name.focus();
if (!setup && (await isSignedIn())) location.replace(next());
