// Views of the map that people saved on the server, and the link to what is shown.

import { idHere } from "../shared/address.js";
import { readMapViews, removeMapView, saveMapView } from "../shared/api.js";
import { copied, html, nothing, targetOf, within } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { t } from "../shared/texts.js";
import { page } from "./page.js";
import { format } from "./state.js";

/** @import {Act} from "./bar.js" */

const id = idHere();

/**
 * What is done with saved views; a refusal is shown by the caller.
 * @param {() => void} draw the page
 */
export function savedOf(draw) {
  async function read() {
    page.saved.all = (await readMapViews(id)).views;
    draw();
  }
  return {
    read,
    async keep(/** @type {string} */ name) {
      await saveMapView(id, { name, query: format(page.state) });
      await read();
    },
    async remove(/** @type {string} */ view) {
      await removeMapView(id, view).finally(read);
    },
  };
}

/** Copies the link to what is shown, or says that it stands above. */
export async function share() {
  history.replaceState(null, "", `?${format(page.state)}`);
  page.reading = t((await copied(location.href)) ? "link-copied" : "link-above");
}

/** The section of the panel. */
export function savedSection(/** @type {Act} */ act) {
  const { saved, mayProcess: may } = page;
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const field = within(targetOf(event), "input", HTMLInputElement);
    if (!field.value.trim()) return;
    act.save(field.value.trim());
    field.value = "";
  };
  return html`<section aria-labelledby="views-title">
    <h2 id="views-title">${t("saved-views")}</h2>
    <ul class="rows">
      ${saved.all.map(
        ({ id: view, name, query, who, time }) =>
          html`<li>
            <button type="button" class="place" @click=${() => act.open(query)}>
              ${name} <small>${who}, ${when(time)}</small></button
            >${
              may
                ? html`<button
                    type="button"
                    aria-label=${t("remove-view", { name })}
                    @click=${() => act.forget(view)}
                  >
                    ×
                  </button>`
                : nothing
            }
          </li>`,
      )}
    </ul>
    ${
      may
        ? html`<form class="line" @submit=${submit}>
            <label
              ><span>${t("name-of-view")}</span><input maxlength="100" required autocomplete="off"
            /></label>
            <button>${t("save-view")}</button>
          </form>`
        : nothing
    }
    <p class="quiet">${t("views-kept")}</p>
  </section>`;
}
