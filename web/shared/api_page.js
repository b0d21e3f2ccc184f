// The API as a page, made from openapi.json: works without internet.

import { wholeUrl } from "./address.js";
import { readCurrentUser, readOpenApi } from "./api.js";
import { attempt, byId, html, nothing, render, targetOf, within } from "./dom.js";
import { example, limits, typeText } from "../projects/schema.js";
import "./page_head.js";

/**
 * @import {Content} from "./dom.js"
 * @import {Body, OpenApi, Operation, Schema} from "../projects/schema.js"
 */

/** @type {OpenApi | undefined} */
const api = await attempt(byId("message"), readOpenApi);
const me = await readCurrentUser();
const schemas = api?.components?.schemas ?? {};
/** @type {Record<string, string>} */
const EXAMPLES = {
  "Tus-Resumable": "1.0.0",
  "Upload-Offset": "0",
  "Upload-Length": "114359304",
};
const anchor = (/** @type {string} */ text) => text.replace(/[^A-Za-z0-9]+/g, "-").toLowerCase();

/**
 * @param {string[]} heads
 * @param {Content[]} rows
 */
function table(heads, rows) {
  const head = html`<thead>
    <tr>
      ${heads.map((/** @type {string} */ text) => html`<th scope="col">${text}</th>`)}
    </tr>
  </thead>`;
  return html`<div class="scroll" tabindex="0" role="group" aria-label=${heads.join(", ")}>
    <table>
      ${head}
      <tbody>
        ${rows}
      </tbody>
    </table>
  </div>`;
}

/**
 * @param {string} name
 * @param {...Content} cells
 */
const row = (name, ...cells) =>
  html`<tr>
    <th scope="row"><code>${name}</code></th>
    ${cells.map((cell) => html`<td>${cell}</td>`)}
  </tr>`;

/** A type, linked to its schema. */
function typeLink(/** @type {Schema} */ schema) {
  const text = typeText(schema);
  const named = text.split(" ").find((/** @type {string} */ word) => schemas[word]);
  return named ? html`<a href="#schema-${named}">${text}</a>` : text;
}

/** A description as plain text. */
const withoutBackticks = (text = "") => text.replaceAll("`", "");

/** The permission an operation requires, and whether the signed-in person lacks it. */
function permissionNote(/** @type {string[]} */ required = []) {
  const text = required.filter((one) => one !== "look").join(", ");
  if (!text) return nothing;
  const missing = required.some((one) => !me.may.some((mine) => mine === one));
  const note = `Requires the permission: ${text}${missing ? ". You do not have it." : ""}`;
  return html`<span class="needs">${note}</span>`;
}

const code = (/** @type {string} */ text) => html`<pre tabindex="0">${text}</pre>`;

function copyable(/** @type {string} */ text) {
  const copy = async (/** @type {Event} */ event) => {
    await navigator.clipboard.writeText(text);
    targetOf(event).textContent = "Copied";
  };
  return html`<div class="copy">
    ${code(text)}<button type="button" @click=${copy}>Copy</button>
  </div>`;
}

function fieldRows(/** @type {Schema} */ schema) {
  const needed = new Set(schema.required ?? []);
  return Object.entries(schema.properties ?? {}).map(([name, one]) =>
    row(
      name,
      typeLink(one),
      [needed.has(name) ? "required" : "", limits(one)].filter(Boolean).join(", "),
      withoutBackticks(one.description),
    ),
  );
}

/**
 * A command line that calls the operation.
 * @param {string} path
 * @param {string} method
 * @param {Operation} operation
 * @param {Body | null} body
 */
function curl(path, method, operation, body) {
  const query = (operation.parameters ?? []).filter((one) => one.in === "query" && one.required);
  /** @type {Record<string, any>} */
  const values = Object.fromEntries(
    (operation.parameters ?? []).map((one) => [
      one.name,
      example(one.schema ?? {}, schemas, one.name),
    ]),
  );
  const filled = path.replace(/\{(\w+)\}/g, (/** @type {string} */ _, /** @type {string} */ name) =>
    encodeURIComponent(values[name] ?? name),
  );
  const asked = query.length
    ? `?${query.map((one) => `${one.name}=${encodeURIComponent(values[one.name])}`).join("&")}`
    : "";
  const headers = (operation.parameters ?? []).filter((one) => one.in === "header" && one.required);
  const parts = ["curl"];
  if (method !== "get") parts.push(`-X ${method.toUpperCase()}`);
  if (me.login)
    parts.push("-b cookies.txt", ...(method === "get" ? [] : ["-H 'X-Recon4-Token: TOKEN'"]));
  for (const one of headers) parts.push(`-H '${one.name}: ${EXAMPLES[one.name] ?? "…"}'`);
  if (body?.json)
    parts.push("-H 'Content-Type: application/json'", `-d '${JSON.stringify(body.json)}'`);
  if (body?.binary) parts.push(`-H 'Content-Type: ${body.binary}'`, "--data-binary @walk.pcap");
  return `${parts.join(" ")} '${wholeUrl(filled + asked)}'`;
}

function bodyOf(/** @type {Operation} */ { requestBody }) {
  const content = requestBody?.content ?? {};
  const json = content["application/json"]?.schema;
  if (json) return { json: example(json, schemas), schema: json };
  const [binary] = Object.keys(content);
  return binary ? { binary } : null;
}

function responseTable({ responses = {} }) {
  const rows = Object.entries(responses).map(([status, one]) => {
    const [[kind, content] = []] = Object.entries(one.content ?? {});
    const text = content?.schema ? typeLink(content.schema) : (kind ?? "nothing");
    return row(status, text, one.description ?? "");
  });
  return [html`<h3>Responses</h3>`, table(["Status", "Type", "Description"], rows)];
}

/**
 * @param {string} path
 * @param {string} method
 * @param {Operation} operation
 */
function operationDetails(path, method, operation) {
  const body = bodyOf(operation);
  const given = operation.parameters ?? [];
  const inputs = given.map((one) =>
    row(
      one.name,
      one.in,
      typeText(one.schema),
      [one.required ? "required" : "", limits(one.schema ?? {})].filter(Boolean).join(", "),
      withoutBackticks(one.description),
    ),
  );
  const schema = body?.schema?.$ref && schemas[typeText(body.schema)];
  const ok = Object.entries(operation.responses ?? {}).find(([status]) =>
    status.startsWith("2"),
  )?.[1]?.content?.["application/json"]?.schema;
  return [
    html`<p>${withoutBackticks(operation.description)}</p>`,
    inputs.length
      ? html`<h3>Parameters</h3>
          ${table(["Name", "In", "Type", "Constraints", "Description"], inputs)}`
      : nothing,
    schema
      ? html`<h3>Body, JSON</h3>
          ${table(["Field", "Type", "Constraints", "Description"], fieldRows(schema))}
          ${code(JSON.stringify(body?.json, null, 1))}`
      : nothing,
    body?.binary
      ? html`<h3>Body</h3>
          <p><code>${body.binary}</code></p>`
      : nothing,
    responseTable(operation),
    ok && Object.keys(ok).length
      ? html`<h3>Example of a response</h3>
          ${code(JSON.stringify(example(ok, schemas), null, 1))}`
      : nothing,
    html`<h3>Try it</h3>`,
    copyable(curl(path, method, operation, body)),
  ];
}

/**
 * An operation, whose details are drawn when it is opened.
 * @param {string} path
 * @param {string} method
 * @param {Operation} operation
 */
function route(path, method, operation) {
  const draw = (/** @type {Event} */ event) =>
    render(operationDetails(path, method, operation), within(targetOf(event), "summary + div"));
  return html`<details class="route" id=${anchor(`${method} ${path}`)} @toggle=${draw}>
    <summary>
      <span class="method ${method}">${method.toUpperCase()}</span><code>${path}</code
      ><span class="quiet">${operation.summary ?? ""}</span>${permissionNote(operation["x-needs"])}
    </summary>
    <div></div>
  </details>`;
}

/** The operations by their first tag. */
function byTag() {
  /** @type {Map<string, Content[]>} */
  const tags = new Map();
  for (const [path, methods] of Object.entries(api?.paths ?? {}))
    for (const [method, operation] of Object.entries(methods)) {
      const tag = operation.tags?.[0] ?? "other";
      tags.set(tag, [...(tags.get(tag) ?? []), route(path, method, operation)]);
    }
  return tags;
}

const title = (/** @type {string} */ text) => text.charAt(0).toUpperCase() + text.slice(1);
const schemaSections = Object.entries(schemas).map(
  ([name, one]) =>
    html`<details class="route" id="schema-${name}">
      <summary><code>${name}</code></summary>
      <div>
        <p>${withoutBackticks(one.description)}</p>
        ${table(["Field", "Type", "Constraints", "Description"], fieldRows(one))}
      </div>
    </details>`,
);
const tags = byTag();
render(
  [...tags.keys(), "schemas"].map((tag) => html`<a href="#tag-${tag}">${title(tag)}</a>`),
  byId("groups"),
);
render(
  [
    [...tags].map(([tag, routes]) => [html`<h2 id="tag-${tag}">${title(tag)}</h2>`, routes]),
    html`<h2 id="tag-schemas">Schemas</h2>`,
    schemaSections,
  ],
  byId("paths"),
);

/** Opens the section that the # of the address names. */
function openNamed() {
  const named = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!named) return;
  if (named instanceof HTMLDetailsElement) named.open = true;
  named.scrollIntoView();
}
addEventListener("hashchange", openNamed);
openNamed();
