// The types of what the pages use of lit-html.js, which is the file of lit-html 3.3.3 as published.

/** What a template draws; made by `html` and `svg`, drawn by `render`. */
export interface TemplateResult {
  readonly strings: TemplateStringsArray;
  readonly values: unknown[];
}

/** A template of HTML: values become text, attributes, properties .x, booleans ?x, events @x. */
export function html(strings: TemplateStringsArray, ...values: unknown[]): TemplateResult;
/** A template of what is inside an `<svg>`. */
export function svg(strings: TemplateStringsArray, ...values: unknown[]): TemplateResult;
/** Draws nothing, or leaves an attribute out. */
export const nothing: unique symbol;
/** Draws into an element that nobody else fills; only what has changed is touched. */
export function render(value: unknown, container: HTMLElement | DocumentFragment): unknown;
