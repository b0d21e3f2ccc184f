// The usual views, by name.

import { t } from "../shared/texts.js";

/**
 * @typedef {{text: string, key: string, yaw: number, pitch: number, parallel?: boolean}} NamedView
 */

const DEG = Math.PI / 180;

/** @type {Record<string, NamedView>} */
export const VIEWS = {
  oblique: { text: t("view-oblique"), key: "5", yaw: 30 * DEG, pitch: -52 * DEG },
  top: { text: t("view-top"), key: "7", yaw: 0, pitch: -90 * DEG },
  front: { text: t("view-front"), key: "1", yaw: 0, pitch: 0 },
  back: { text: t("view-back"), key: "2", yaw: 180 * DEG, pitch: 0 },
  right: { text: t("view-right"), key: "3", yaw: -90 * DEG, pitch: 0 },
  left: { text: t("view-left"), key: "4", yaw: 90 * DEG, pitch: 0 },
};
