// Texts of a page in the language of the person, from the Fluent files that the server has, too.
// The server says in <html> which language and file it is, and which languages there are.

import { at, keepForServer } from "./address.js";
import { FluentBundle, FluentResource } from "./vendor/fluent/index.js";

/** @typedef {Record<string, string | number>} Values what a text quotes */
/** @typedef {(given: any[], options: Record<string, any>) => string} TextFunction */

const ENGLISH = "en";
const COOKIE = "recon4_language";
const NARROW = "\u202f";

/** The bundles of this page: its language first, then English. */
const state = { bundles: /** @type {FluentBundle[]} */ ([]), language: ENGLISH };

/** The decimal sign of a language: 12.5 -> "12,5". */
const localized = (/** @type {string} */ text, /** @type {string} */ language) =>
  text.replace(
    ".",
    new Intl.NumberFormat(language).formatToParts(1.5).find(({ type }) => type === "decimal")
      ?.value ?? ".",
  );

/**
 * What texts call for numbers; `recon4/locales/numbers.py` has the same for the server.
 * @param {string} language
 * @returns {Record<string, TextFunction>}
 */
const functions = (language) => ({
  DECIMAL: ([value], { digits }) => localized(Number(value).toFixed(digits), language),
  PERCENT: ([ratio], { digits }) =>
    `${localized((100 * Number(ratio)).toFixed(digits), language)} %`,
  COUNT: ([number]) => String(Math.round(number)).replace(/\B(?=(\d{3})+$)/g, NARROW),
});

/**
 * Takes the texts of a language; those that were added before come first.
 * @param {string} language
 * @param {string} source a Fluent file
 */
export function addTexts(language, source) {
  if (!state.bundles.length) state.language = language;
  const bundle = new FluentBundle(language, {
    useIsolating: false,
    functions: /** @type {any} */ (functions(language)),
  });
  bundle.addResource(new FluentResource(source));
  state.bundles.push(bundle);
}

/** Reads the texts of this page; to be awaited before the first text is shown. */
export async function loadTexts() {
  const { lang, dataset } = document.documentElement;
  const languages = [...new Set([lang || ENGLISH, ENGLISH])];
  const sources = await Promise.all(
    languages.map(async (one) => {
      const response = await fetch(at(`/texts/${one}/${dataset.texts}.ftl`));
      return response.ok ? response.text() : "";
    }),
  );
  languages.forEach((one, k) => addTexts(one, sources[k] ?? ""));
}

/**
 * The text of a message with the values that it quotes.
 * @param {string} id
 * @param {Values} [values]
 */
export function t(id, values = {}) {
  for (const bundle of state.bundles) {
    const pattern = bundle.getMessage(id)?.value;
    if (pattern) return bundle.formatPattern(pattern, values);
  }
  return id;
}

/** Whether there is a text. */
export const hasText = (/** @type {string} */ id) =>
  state.bundles.some((bundle) => bundle.hasMessage(id));

/** The language of this page, for numbers and times. */
export const language = () => state.language;

/** All languages of this page with their own names: [[code, name], …]. */
export const languages = () =>
  (document.documentElement.dataset.languages ?? ENGLISH)
    .split(" ")
    .map((code) => [code, new Intl.DisplayNames([code], { type: "language" }).of(code) ?? code]);

/** Shows this page, and the others that are translated, in another language. */
export function chooseLanguage(/** @type {string} */ code) {
  keepForServer(COOKIE, code);
  location.reload();
}
