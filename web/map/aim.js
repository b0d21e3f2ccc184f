// Tools by keyboard: the cross in the middle of the image is the pointer, Space is the click.

import { t } from "../shared/texts.js";
import { toScreen } from "./camera.js";
import { page } from "./page.js";
import { dragged, onLevel } from "./tools.js";

/** @import {Stage} from "./tools.js" */

/**
 * What Space does.
 * @param {Stage} stage
 * @param {(at: number[]) => void} click
 */
export function aimOf(stage, click) {
  const middle = () => [stage.screen().width / 2, stage.screen().height / 2];

  /** Where the drag of a box or a section began, in the image as it is now. */
  function begun() {
    const { from } = page.aim;
    const at = from && toScreen(stage.camera(), stage.screen(), from);
    return at ? [at.x, at.y] : null;
  }

  return {
    /** Picks what is in the middle, or begins and ends the drag of a tool there. */
    press() {
      page.aim.on = true;
      if (page.tool !== "box" && page.tool !== "section") return click(middle());
      const from = begun();
      page.aim.from = from ? null : onLevel(middle(), stage);
      if (from) return dragged(from, middle(), { ...stage, done: true });
      page.reading = t("move-on");
      return stage.draw();
    },
    /** The pointer is used again. */
    end() {
      if (!page.aim.on) return;
      Object.assign(page.aim, { on: false, from: null });
      stage.draw();
    },
    /** The drag that is shown, while the cross moves. */
    dragShown() {
      const from = page.aim.on ? begun() : null;
      return from ? [from, middle()] : null;
    },
  };
}
