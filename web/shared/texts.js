// Texts of a page in the language of the person, from the Fluent files that the server has, too.
// The server puts them into the page, so they are there before any module asks: a constant of a
// module may be a text. <html> says which language it is, and which there are.

import { keepForServer } from "./address.js";
import { FluentBundle, FluentResource } from "./vendor/fluent/index.js";

/** @typedef {Record<string, string | number>} Values what a text quotes */
/** @typedef {(given: any[], options: Record<string, any>) => string} TextFunction */

const ENGLISH = "en";
const COOKIE = "recon4_language";
const NARROW = "\u202f";
const DEGREES_PER_RAD = 180 / Math.PI;

/** The bundles of this page: its language first, then English. */
const state = { bundles: /** @type {FluentBundle[]} */ ([]), language: ENGLISH };

/** The decimal sign of a language: 12.5 -> "12,5". */
const localized = (/** @type {string} */ text, /** @type {string} */ language) =>
  text.replace(
    ".",
    new Intl.NumberFormat(language).formatToParts(1.5).find(({ type }) => type === "decimal")
      ?.value ?? ".",
  );

/** A number with its digits; what is rounded to zero has no sign: -0.04 -> "0.0". */
const rounded = (/** @type {number} */ value, /** @type {number} */ digits) => {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text;
};

/**
 * A number with a sign if one is asked for.
 * @param {number | string} value
 * @param {{digits?: number, sign?: number}} how
 */
const fixed = (value, { digits = 0, sign = 0 }) => {
  const text = rounded(Number(value), digits);
  return sign && !text.startsWith("-") ? `+${text}` : text;
};

/**
 * What texts call for numbers; `recon4/locales/numbers.py` has the same for the server.
 * @param {string} language
 * @returns {Record<string, TextFunction>}
 */
const functions = (language) => ({
  DECIMAL: ([value], how) => localized(fixed(value, how), language),
  PERCENT: ([ratio], how) => `${localized(fixed(100 * Number(ratio), how), language)} %`,
  DEGREES: ([rad], how) => `${localized(fixed(DEGREES_PER_RAD * Number(rad), how), language)}°`,
  LENGTH: ([m]) =>
    localized(
      m < 1 ? `${fixed(100 * m, { digits: 1 })} cm` : `${fixed(m, { digits: 2 })} m`,
      language,
    ),
  COUNT: ([number]) => String(Math.round(number)).replace(/\B(?=(\d{3})+$)/g, NARROW),
});

/**
 * Takes the texts of a language; those that were added before come first.
 * @param {string} language
 * @param {string} source Fluent messages
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

/** @type {Array<[string, string]>} */
const sources = JSON.parse(globalThis.document?.getElementById("texts")?.textContent ?? "[]");
for (const [language, source] of sources) addTexts(language, source);

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

/**
 * What a word of the server is called, by the message PREFIX-WORD; else the word itself, which
 * keeps its capital letters also where the English message is the same.
 * @param {string} prefix
 * @param {string} word
 * @param {Values} [values]
 */
export function wordOf(prefix, word, values = {}) {
  const id = `${prefix}-${word
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-|-$/g, "")}`;
  const text = hasText(id) ? t(id, values) : word;
  const english = state.language === ENGLISH || !state.bundles[0]?.hasMessage(id);
  return english && text.toLowerCase() === word.toLowerCase() ? word : text;
}

/** A number as the language writes it: decimal(12.34, 1) -> "12,3". */
export const decimal = (/** @type {number} */ value, digits = 0) =>
  localized(rounded(value, digits), state.language);

/** A number with all of its digits: 0.05 -> "0,05". */
export const asWritten = (/** @type {number} */ value) => localized(String(value), state.language);

/** A number that is a text already, with the decimal sign of the language: "12.5 m" -> "12,5 m". */
export const written = (/** @type {string} */ text) => localized(text, state.language);

/** The language of this page. */
export const language = () => state.language;

/** The language as browsers write dates and times in it. */
export const locale = () => (state.language === ENGLISH ? "en-GB" : state.language);

/** All languages of this page with their own names: [[code, name], …]. */
export const languages = () =>
  (document.documentElement.dataset.languages ?? ENGLISH)
    .split(" ")
    .map((code) => [code, new Intl.DisplayNames([code], { type: "language" }).of(code) ?? code]);

/** Shows this page, and all others, in another language. */
export function chooseLanguage(/** @type {string} */ code) {
  keepForServer(COOKIE, code);
  location.reload();
}
