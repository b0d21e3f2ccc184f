// What all pages need to draw. Templates are drawn by lit-html: text is always text, never HTML.

import { at } from "./address.js";
import { html, nothing, render } from "./vendor/lit-html/lit-html.js";

export { html, nothing, render, svg } from "./vendor/lit-html/lit-html.js";
export { repeat } from "./vendor/lit-html/directives/repeat.js";

/**
 * @typedef {import("./vendor/lit-html/lit-html.js").TemplateResult} Template
 * @typedef {Template | symbol | string | number | null | undefined} Content what is drawn
 */

/**
 * The element with an id, of a class if one is given.
 * @template {HTMLElement} [E=HTMLElement]
 * @param {string} id
 * @param {new () => E} [kind]
 * @returns {E}
 */
export const byId = (id, kind) => within(document, `#${CSS.escape(id)}`, kind);

/**
 * The first element below `root` that a selector names, of a class if one is given.
 * @template {HTMLElement} [E=HTMLElement]
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => E} [kind]
 * @returns {E}
 */
export function within(root, selector, kind = /** @type {any} */ (HTMLElement)) {
  const element = root.querySelector(selector);
  if (!(element instanceof kind))
    throw new Error(`${kind.name} ${selector} expected, got ${element}`);
  return element;
}

/**
 * An element of the page by its name, as `page-head`.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @returns {HTMLElementTagNameMap[K]}
 */
export function only(tag) {
  const element = document.querySelector(tag);
  if (!element) throw new Error(`<${tag}> expected`);
  return element;
}

/** The controls of a form by name. */
export const fields = (/** @type {HTMLFormElement} */ form) =>
  /** @type {Record<string, HTMLInputElement>} */ (/** @type {unknown} */ (form.elements));

/**
 * Gives a form of the page its listener, and then enables its button. A form that is submitted
 * before its script has loaded puts its fields, a password too, into the address.
 * @param {HTMLFormElement} form
 * @param {(event: SubmitEvent) => unknown} listener
 */
export function onSubmit(form, listener) {
  form.addEventListener("submit", listener);
  for (const button of form.querySelectorAll("button")) button.disabled = false;
}

/** The control an event began at. */
export const targetOf = (/** @type {Event} */ event) =>
  /** @type {HTMLInputElement} */ (event.target);

/** What an element of ours sent with an event. */
export const detailOf = (/** @type {Event} */ event) => /** @type {CustomEvent} */ (event).detail;

/** What was thrown, as an error. */
export const asError = (/** @type {unknown} */ thrown) =>
  /** @type {Error & Partial<import("./http.js").ApiError>} */ (
    thrown instanceof Error ? thrown : new Error(String(thrown))
  );

/** A place for errors, which stays empty until `attempt` or `say` fills it. */
export const messagePlace = () => html`<p class="error" role="alert"></p>`;

/**
 * Shows a text or template in an element that only this function fills; empty takes it away.
 * @param {HTMLElement} element
 * @param {Content} content
 */
export const say = (element, content) => render(content || nothing, element);

/**
 * A link to the page where the remedy of an error is. It opens beside this one, which may have
 * fields filled in and be needed again.
 */
export const remedyLink = (/** @type {{text: string, page: string}} */ { text, page }) =>
  html`<a class="button remedy" href=${at(page)} target="_blank" rel="noopener">${text}</a>`;

/**
 * Shows an error with what helps against it; `before` stands in front of its message.
 * @param {HTMLElement} element
 * @param {unknown} thrown
 */
export function showError(element, thrown, before = "") {
  const { message, remedy } = asError(thrown);
  say(element, html`${before}${message}${remedy ? html` ${remedyLink(remedy)}` : nothing}`);
}

/**
 * Returns the result of an action; an error is shown in `message`, the result is undefined.
 * @template T
 * @param {HTMLElement} message
 * @param {() => T | Promise<T>} action
 * @returns {Promise<T | undefined>}
 */
export async function attempt(message, action) {
  say(message, "");
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
 * @param {HTMLElement} message
 * @param {() => unknown} action
 */
export async function succeeds(message, action) {
  const done = async () => {
    await action();
    return true;
  };
  return (await attempt(message, done)) ?? false;
}

/**
 * The same work, but not again while it is done: a double press does it once.
 * @template {unknown[]} A
 * @param {(...given: A) => Promise<unknown>} work
 * @returns {(...given: A) => Promise<unknown>}
 */
export function once(work) {
  /** @type {Promise<unknown> | null} */
  let running = null;
  return (...given) => (running ??= work(...given).finally(() => (running = null)));
}

/** Whether a text is in the clipboard now: some browsers have none, or ask the person first. */
export const copied = (/** @type {string} */ text) =>
  Promise.resolve(navigator.clipboard?.writeText(text) ?? Promise.reject()).then(
    () => true,
    () => false,
  );
