// The dialog of a project in the list: tags, archive, what can be freed.

import { changeProject, freeSpace } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, fields, html, messagePlace, nothing, within } from "../shared/dom.js";
import { bytes } from "../shared/format.js";

/** @import {Freeable, ProjectCard, ProjectSpace} from "../shared/http_types" */

/** @type {Record<Freeable, string>} */
const FREEABLE = {
  earlier: "Results of earlier runs",
  frames: "Points as recorded: no new decisions until it was processed again",
  map: "Tiles of the map: no viewer, slices and exports until it was processed again",
};

/** Size, and what of it can be freed, in one line. */
export function spaceText(/** @type {ProjectSpace} */ { bytes: size, freeable }) {
  const free = Object.values(freeable).reduce((sum, one) => sum + one, 0);
  return free ? `${bytes(size)}, ${bytes(free)} can be freed` : bytes(size);
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
    `Organize ${project.name}`,
    html`<form class="organize" @submit=${save}>
      <label
        ><span>Tags, with commas between</span
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
          >Archived: not in the list at first; nothing is moved or deleted</span
        ></label
      >
      ${
        choices.length
          ? html`<fieldset>
              <legend>Free space; processing the recording again makes it again</legend>
              ${choices.map(free)}
            </fieldset>`
          : nothing
      }
      ${messagePlace()}
      <div class="buttons">${closeButton()}<button class="primary">Save</button></div>
    </form>`,
  );
}
