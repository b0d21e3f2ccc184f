// <delivery-check>: what a delivery is, and what its verification says.

import { idHere } from "../shared/address.js";
import { checkDelivery } from "../shared/api.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { t, wordOf } from "../shared/texts.js";

/** @import {DeliveryCheck, DeliveryOrder} from "../shared/http_types" */

/** What is in a delivery, in words. */
export const deliveryWords = (
  /** @type {DeliveryOrder} */ { files, exports = [], license = "", language },
) => [
  [...files, ...exports.map(({ file }) => file)].join(", "),
  new Intl.DisplayNames([document.documentElement.lang], { type: "language" }).of(language) ?? "",
  t(license ? "delivery-with-license" : "delivery-without-license"),
];

export class DeliveryCheckButton extends HTMLElement {
  export = "";
  /** @type {DeliveryCheck | null} */
  #found = null;
  #busy = false;

  connectedCallback() {
    this.#draw();
  }

  #draw() {
    render(
      html`<button type="button" ?disabled=${this.#busy} @click=${this.#check}>
          ${t("delivery-verify")}
        </button>
        <div role="status">${this.#busy ? t("delivery-verifying") : this.#result()}</div>
        ${messagePlace()}`,
      this,
    );
  }

  #check = async () => {
    [this.#busy, this.#found] = [true, null];
    this.#draw();
    await attempt(within(this, ".error"), async () => {
      this.#found = await checkDelivery(idHere(), this.export);
    });
    this.#busy = false;
    this.#draw();
  };

  #result() {
    const found = this.#found;
    if (!found) return nothing;
    const named = /** @type {const} */ (["altered", "missing", "added"]).filter(
      (kind) => found[kind].length,
    );
    return html`<p class=${named.length ? "error" : ""}>
        ${named.length ? "✕" : "✓"} ${t("verify-intact", { count: found.intact.length })}
      </p>
      ${named.map(
        (kind) => html`<p class="error">${t(`verify-${kind}`)} ${found[kind].join(", ")}</p>`,
      )}
      <p>
        ${found.signer ? t("verify-signed", { signer: signerText(found.signer) }) : found.doubt}
      </p>`;
  }
}

/** "this server, key ab12" in the language of the page. */
function signerText(/** @type {string} */ signer) {
  const [name, key = ""] = signer.split(", key ");
  return key ? t("verify-signer", { name: wordOf("signer", name), key }) : signer;
}

customElements.define("delivery-check", DeliveryCheckButton);
