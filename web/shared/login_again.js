// The login over a page whose session has ended: what was begun on the page stays there.

import { signIn } from "./api/people.js";
import { openDialog } from "./dialog.js";
import { attempt, fields, html, messagePlace, within } from "./dom.js";
import { t } from "./texts.js";

/**
 * Whether the same person has signed in again; another one gets the page from the server.
 * @param {string} who
 * @returns {Promise<boolean>}
 */
export function askLogin(who) {
  const answer = { right: false };
  const submit = async (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const { name, password } = fields(within(dialog, "form", HTMLFormElement));
    const me = await attempt(within(dialog, ".error"), () => signIn(name.value, password.value));
    if (me && me.name !== who) return location.reload();
    answer.right = me !== undefined;
    if (me) dialog.close();
    else password.select();
  };
  const dialog = openDialog(
    t("sign-in"),
    html`<form @submit=${submit}>
      <p class="quiet">${t("session-ended")}</p>
      <label
        ><span>${t("name")}</span
        ><input
          name="name"
          autocomplete="username"
          autocapitalize="none"
          maxlength="64"
          required
          .value=${who}
      /></label>
      <label
        ><span>${t("password")}</span
        ><input
          name="password"
          type="password"
          autocomplete="current-password"
          maxlength="256"
          required
          autofocus
      /></label>
      ${messagePlace()}
      <div class="buttons"><button class="primary">${t("sign-in")}</button></div>
    </form>`,
  );
  dialog.classList.add("login-again");
  within(dialog, "[name=password]").focus();
  return new Promise((resolve) =>
    dialog.addEventListener("close", () => resolve(answer.right), { once: true }),
  );
}
