// Classes of points and their corrections in words. No DOM, no network.

import { t, wordOf, written } from "./texts.js";

/** Why nothing is to be changed, as the server writes it, in words of the page. */
export function whyText(/** @type {string} */ text) {
  const [, away] = text.match(/^there is no point in it: the map ends (\S+) m away$/) ?? [];
  if (away) return t("correct-none-near", { away: written(away) });
  if (text === "there is no point in it") return t("correct-none");
  const [, all] = text.match(/^all points in it are (.+) already$/) ?? [];
  if (all) return t("correct-already", { class: classText(all) });
  const [, there] = text.match(/^no point in it has a class that is corrected; it has (.+)$/) ?? [];
  const named = there?.replace(/[^,(]+(?= \()/g, (title) => classText(title.trim()));
  return named ? t("correct-others", { classes: named.replace(/,(?=\S)/g, ", ") }) : text;
}

/** A class of points in words. */
export const classText = (/** @type {string} */ title) => wordOf("class", title);
