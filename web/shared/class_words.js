// Classes of points in words. No DOM, no network.

import { wordOf } from "./texts.js";

/** A class of points in words. */
export const classText = (/** @type {string} */ title) => wordOf("class", title);
