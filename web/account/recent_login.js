// What is signed with one's name asks for the password again when it was given long ago.

import { ApiError, signInAgain } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/**
 * Runs an action; if the server wants the password again, asks for it and runs it once more.
 * @template T
 * @param {() => Promise<T>} action
 */
export async function withPassword(action) {
  try {
    return await action();
  } catch (error) {
    if (!(error instanceof ApiError) || error.name !== "SignInAgain" || !(await askPassword()))
      throw error;
    return action();
  }
}

/**
 * Whether the right password was given; false if the person cancelled.
 * @returns {Promise<boolean>}
 */
function askPassword() {
  const answer = { right: false };
  const submit = async (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const password = within(dialog, "input", HTMLInputElement);
    const message = within(dialog, ".error");
    answer.right = (await attempt(message, () => signInAgain(password.value))) !== undefined;
    if (answer.right) dialog.close();
    else password.select();
  };
  const dialog = openDialog(
    t("password-again"),
    html`<form @submit=${submit}>
      <p class="quiet">${t("password-why")}</p>
      <label
        ><span>${t("password")}</span
        ><input type="password" autocomplete="current-password" required maxlength="256"
      /></label>
      ${messagePlace()}
      <div class="buttons">${closeButton()}<button class="primary">${t("confirm")}</button></div>
    </form>`,
  );
  return new Promise((resolve) =>
    dialog.addEventListener("close", () => resolve(answer.right), { once: true }),
  );
}
