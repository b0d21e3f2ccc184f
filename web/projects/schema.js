// JSON schemas of openapi.json as short texts and as examples. No DOM, no network.

/**
 * @typedef {object} Schema as far as the server writes them
 * @property {string} [$ref]
 * @property {Schema[]} [anyOf]
 * @property {any[]} [enum]
 * @property {any} [const]
 * @property {string} [type]
 * @property {Schema} [items]
 * @property {Schema} [additionalProperties]
 * @property {Record<string, Schema>} [properties]
 * @property {string[]} [required]
 * @property {string} [description]
 * @property {any} [example]
 * @property {any} [default]
 * @property {number} [minimum]
 * @property {number} [maximum]
 * @property {number} [minLength]
 * @property {number} [maxLength]
 * @property {number} [minItems]
 * @property {number} [maxItems]
 * @property {string} [pattern]
 *
 * @typedef {{name: string, in: string, required?: boolean, schema?: Schema, description?: string}}
 *   Parameter
 * @typedef {Record<string, {schema?: Schema}>} ContentTypes
 * @typedef {object} Operation
 * @property {string[]} [tags]
 * @property {string} [summary]
 * @property {string} [description]
 * @property {Parameter[]} [parameters]
 * @property {{content?: ContentTypes}} [requestBody]
 * @property {Record<string, {description?: string, content?: ContentTypes}>} [responses]
 * @property {string[]} [x-needs]
 *
 * @typedef {{json?: any, schema?: Schema, binary?: string}} Body an example of a request's body
 * @typedef {object} OpenApi
 * @property {{schemas?: Record<string, Schema>}} [components]
 * @property {Record<string, Record<string, Operation>>} paths
 */

const nameOf = (/** @type {string} */ ref) => ref.split("/").at(-1) ?? "";

/**
 * A type as a short text: `string`, `list of JobView`, `number or null`.
 * @returns {string}
 */
export function typeText(/** @type {Schema} */ schema = {}) {
  if (schema.$ref) return nameOf(schema.$ref);
  if (schema.anyOf) return schema.anyOf.map((one) => typeText(one)).join(" or ");
  if (schema.enum) return schema.enum.map((one) => JSON.stringify(one)).join(" or ");
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.type === "array")
    return `list of ${schema.items ? typeText(schema.items) : "anything"}`;
  if (schema.type === "object" && schema.additionalProperties)
    return `map of text to ${typeText(schema.additionalProperties)}`;
  return schema.type ?? "anything";
}

/** Limits of a value: `1 to 200 letters`, `at least 1`. */
export function limits(
  /** @type {Schema} */ {
    minimum,
    maximum,
    minLength,
    maxLength,
    minItems,
    maxItems,
    pattern,
    default: usual,
  },
) {
  /**
   * @param {number | undefined} low
   * @param {number | undefined} high
   * @param {string} unit
   */
  const span = (low, high, unit) =>
    low === undefined && high === undefined
      ? ""
      : high === undefined
        ? `at least ${low}${unit}`
        : low === undefined
          ? `at most ${high}${unit}`
          : `${low} to ${high}${unit}`;
  return [
    span(minimum, maximum, ""),
    span(minLength, maxLength, " letters"),
    span(minItems, maxItems, " items"),
    pattern ? `pattern ${pattern}` : "",
    usual === undefined ? "" : `default ${JSON.stringify(usual)}`,
  ]
    .filter(Boolean)
    .join(", ");
}

/** @type {Record<string, any>} */
const EXAMPLES = {
  project: "office",
  recordings: ["/data/walk.pcap"],
  settings: ["map.voxel_m=0.05"],
  preset: "indoor",
  name: "walk.pcap",
  clone_of: "",
  rig: "",
  imu: "",
  gnss: "",
  files: 1,
  bytes: 114359304,
  job_id: "3f9a2c1b5d7e8f90",
  project_id: "office",
  path: "/data/walk.pcap",
  upload_id: "9c2d41e07ab3",
  file_id: "9c2d41e07ab3-0",
};

/** @type {Record<string, any>} */
const SIMPLE = { string: "text", integer: 1, number: 0.5, boolean: true };

/**
 * An example of a value.
 * @param {Schema} schema
 * @param {Record<string, Schema>} schemas
 * @returns {any}
 */
export function example(schema, schemas, key = "", depth = 0) {
  if (key in EXAMPLES && !schema.$ref) return EXAMPLES[key];
  if (schema.example !== undefined) return schema.example;
  if (schema.default !== undefined) return schema.default;
  if (schema.$ref)
    return depth > 4 ? {} : example(schemas[nameOf(schema.$ref)] ?? {}, schemas, "", depth + 1);
  if (schema.anyOf) return example(schema.anyOf[0] ?? {}, schemas, key, depth);
  if (schema.enum) return schema.enum[0];
  if (schema.type === "array") return [example(schema.items ?? {}, schemas, key, depth + 1)];
  if (schema.type === "object") {
    const fields = Object.entries(schema.properties ?? {});
    return Object.fromEntries(
      fields.map(([name, one]) => [name, example(one, schemas, name, depth + 1)]),
    );
  }
  return SIMPLE[schema.type ?? ""] ?? null;
}
