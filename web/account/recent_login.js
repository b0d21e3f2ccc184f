// What is signed with one's name asks for the password again when it was given long ago.

import { ApiError, signInAgain } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";

/** Runs an action; if the server wants the password again, asks for it and runs it once more. */
export async function withPassword(action) {
  try {
    return await action();
  } catch (error) {
    if (!(error instanceof ApiError) || error.name !== "SignInAgain" || !(await askPassword()))
      throw error;
    return action();
  }
}

/** Whether the right password was given; false if the person cancelled. */
function askPassword() {
  const password = make("input", {
    type: "password",
    autocomplete: "current-password",
    required: true,
    maxLength: 256,
  });
  const message = make("p", { className: "error", role: "alert" });
  const cancel = make("button", { type: "button", onclick: () => dialog.close() }, "Cancel");
  const form = make(
    "form",
    {},
    make("h2", { id: "again-title" }, "Your password again"),
    make(
      "p",
      { className: "quiet" },
      "This is signed with your name, and you signed in a while ago",
    ),
    make("label", {}, make("span", {}, "Password"), password),
    message,
    make(
      "div",
      { className: "buttons" },
      cancel,
      make("button", { className: "primary" }, "Confirm"),
    ),
  );
  const dialog = make("dialog", { "aria-labelledby": "again-title" }, form);
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    let right = false;
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      right = (await attempt(message, () => signInAgain(password.value))) !== undefined;
      if (right) dialog.close();
      else password.select();
    });
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(right);
    });
  });
}
