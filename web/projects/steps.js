// What the server calls the steps of a run, in the language of the page. No DOM, no network.

import { t, wordOf } from "../shared/texts.js";

const HASH = "hash ";

/** A piece of work, as the stages name it: "odometry", or "hash" with the name of a file. */
export const stepText = (/** @type {string} */ what) =>
  what.startsWith(HASH) ? t("step-hash", { file: what.slice(HASH.length) }) : wordOf("step", what);

/** A stage of the workflow. */
export const stageText = (/** @type {string} */ stage) => wordOf("stage", stage);
