// A text that a person has typed about a pair and not sent yet. It stays with its pair while others
// are looked at, and comes back where the server refuses it.

export class Draft {
  #field;
  #pair = ""; // whose text the field has
  #texts = /** @type {Map<string, string>} */ (new Map());

  /** @param {() => HTMLInputElement | null} field where it is typed, once it is drawn */
  constructor(field) {
    this.#field = field;
  }

  /** Another pair is selected: the field has what was typed about it. */
  show(/** @type {string} */ pair) {
    const field = this.#field();
    if (!field || pair === this.#pair) return;
    this.#texts.set(this.#pair, field.value);
    this.#pair = pair;
    field.value = this.#texts.get(pair) ?? "";
  }

  /** What is sent; the field is empty then. */
  take() {
    const field = this.#field();
    const text = field?.value.trim() ?? "";
    if (field) field.value = "";
    return text;
  }

  /** Was not taken: it is there to be sent again, unless something else was typed since. */
  giveBack(/** @type {string} */ pair, /** @type {string} */ text) {
    const field = this.#field();
    if (pair !== this.#pair) this.#texts.set(pair, this.#texts.get(pair) || text);
    else if (field) field.value ||= text;
  }
}
