// Small helpers to make elements; text is always text, never HTML.

import { at } from "./address.js";

/**
 * The element with an id, of a class if one is given.
 * @template {HTMLElement} [E=HTMLElement]
 * @param {string} id
 * @param {new () => E} [kind]
 * @returns {E}
 */
export function byId(id, kind = /** @type {any} */ (HTMLElement)) {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) throw new Error(`${kind.name} #${id} expected, got ${element}`);
  return element;
}

/** The controls of a form by name. */
export const fields = (form) => /** @type {Record<string, HTMLInputElement>} */ (form.elements);

/**
 * Gives a form of the page its listener, and then enables its button. A form that is submitted
 * before its script has loaded puts its fields, a password too, into the address.
 */
export function onSubmit(form, listener) {
  form.addEventListener("submit", listener);
  for (const button of form.querySelectorAll("button")) button.disabled = false;
}

/** The element an event began at. */
export const targetOf = (event) => /** @type {HTMLInputElement} */ (event.target);

/** A new element: properties or attributes, `on…` listeners, children. */
export function make(tag, props = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(props)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key in element && key !== "list") element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Replaces the children only if that changes the content, so that focus and selection stay. */
export function fill(element, ...children) {
  const fresh = make(element.localName, {}, ...children);
  if (fresh.innerHTML !== element.innerHTML) element.replaceChildren(...fresh.childNodes);
}

/**
 * A link to the page where the remedy of an error is. It opens beside this one, which may have
 * fields filled in and be needed again.
 */
export const remedyLink = ({ text, page }) =>
  make(
    "a",
    { className: "button remedy", href: at(page), target: "_blank", rel: "noopener" },
    text,
  );

/** Shows an error with what helps against it; `before` stands in front of its message. */
export function showError(element, error, before = "") {
  element.textContent = before + error.message;
  if (error.remedy) element.append(" ", remedyLink(error.remedy));
}

/** Returns the result of an action; an error is shown in `message`, the result is undefined. */
export async function attempt(message, action) {
  message.textContent = "";
  try {
    return await action();
  } catch (error) {
    showError(message, error);
    return undefined;
  }
}

/**
 * Whether an action succeeded; an error is shown in `message`. What was changed is read again only
 * then: the success of reading would take the error away.
 */
export async function succeeds(message, action) {
  const done = async () => {
    await action();
    return true;
  };
  return (await attempt(message, done)) ?? false;
}
