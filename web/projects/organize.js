// The dialog of a project in the list: tags, archive, what can be freed.

import { changeProject, freeSpace } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, fields, html, messagePlace, nothing, within } from "../shared/dom.js";
import { bytes } from "../shared/format.js";
import { t } from "../shared/texts.js";

/** @import {Freeable, ProjectCard, ProjectSpace} from "../shared/http_types" */

/** @type {Record<Freeable, string>} */
const FREEABLE = {
  earlier: t("free-earlier"),
  frames: t("free-frames"),
  map: t("free-map"),
};

/** Size, and what of it can be freed, in one line. */
export function spaceText(/** @type {ProjectSpace} */ { bytes: size, freeable }) {
  const free = Object.values(freeable).reduce((sum, one) => sum + one, 0);
  return free ? t("space", { size: bytes(size), free: bytes(free) }) : bytes(size);
}

/**
 * Asks what is to be changed; `done` is called after it was.
 * @param {ProjectCard} project
 * @param {ProjectSpace | undefined} space
 * @param {string[]} tags those of all projects
 * @param {() => unknown} done
 */
export function organize(project, space, tags, done) {
  const choices = /** @type {Array<[Freeable, number]>} */ (Object.entries(space?.freeable ?? {}));
  const save = async (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const form = within(dialog, "form", HTMLFormElement);
    const { tags: given, archived } = fields(form);
    const what = choices.map(([name]) => name).filter((name) => fields(form)[name]?.checked);
    const changes = {
      tags: given.value.split(",").filter((/** @type {string} */ one) => one.trim()),
      archived: archived.checked,
    };
    const act = async () => {
      await changeProject(project.id, changes);
      if (what.length) await freeSpace(project.id, what);
      return true;
    };
    if (!(await attempt(within(dialog, ".error"), act))) return;
    dialog.close();
    done();
  };
  const free = (/** @type {[Freeable, number]} */ [name, size]) =>
    html`<label class="check"
      ><input type="checkbox" name=${name} /><span>${FREEABLE[name]}: ${bytes(size)}</span></label
    >`;
  const dialog = openDialog(
    t("organize-of", { name: project.name }),
    html`<form class="organize" @submit=${save}>
      <label
        ><span>${t("tags")}</span
        ><input
          name="tags"
          .value=${project.tags.join(", ")}
          maxlength="800"
          autocomplete="off"
          list="all-tags"
      /></label>
      <datalist id="all-tags">${tags.map((tag) => html`<option value=${tag}></option>`)}</datalist>
      <label class="check"
        ><input type="checkbox" name="archived" .checked=${project.archived} /><span
          >${t("archive-it")}</span
        ></label
      >
      ${
        choices.length
          ? html`<fieldset>
              <legend>${t("free-space")}</legend>
              ${choices.map(free)}
            </fieldset>`
          : nothing
      }
      ${messagePlace()}
      <div class="buttons">${closeButton()}<button class="primary">${t("save")}</button></div>
    </form>`,
  );
}
