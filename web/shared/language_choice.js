// <language-choice>: the language of all pages, to be chosen on any of them.

import { html, render, targetOf } from "./dom.js";
import { chooseLanguage, language, languages, t } from "./texts.js";

class LanguageChoice extends HTMLElement {
  connectedCallback() {
    render(
      html`<select
        aria-label=${t("language")}
        @change=${(/** @type {Event} */ event) => chooseLanguage(targetOf(event).value)}
      >
        ${languages().map(
          ([code, name]) =>
            html`<option value=${code} lang=${code} ?selected=${code === language()}>
              ${name}
            </option>`,
        )}
      </select>`,
      this,
    );
  }
}

customElements.define("language-choice", LanguageChoice);
