// JSON schemas of openapi.json as short texts and as examples. No DOM, no network.

const nameOf = (ref) => ref.split("/").at(-1);

/** A type as a short text: `string`, `list of JobView`, `number or null`. */
export function typeText(schema = {}) {
  if (schema.$ref) return nameOf(schema.$ref);
  if (schema.anyOf) return schema.anyOf.map(typeText).join(" or ");
  if (schema.enum) return schema.enum.map((one) => JSON.stringify(one)).join(" or ");
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.type === "array")
    return `list of ${schema.items ? typeText(schema.items) : "anything"}`;
  if (schema.type === "object" && schema.additionalProperties)
    return `map of text to ${typeText(schema.additionalProperties)}`;
  return schema.type ?? "anything";
}

/** Limits of a value: `1 to 200 letters`, `at least 1`. */
export function limits({
  minimum,
  maximum,
  minLength,
  maxLength,
  minItems,
  maxItems,
  pattern,
  default: usual,
}) {
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

/** An example of a value. */
export function example(schema, schemas, key = "", depth = 0) {
  if (key in EXAMPLES && !schema.$ref) return EXAMPLES[key];
  if (schema.example !== undefined) return schema.example;
  if (schema.default !== undefined) return schema.default;
  if (schema.$ref)
    return depth > 4 ? {} : example(schemas[nameOf(schema.$ref)] ?? {}, schemas, "", depth + 1);
  if (schema.anyOf) return example(schema.anyOf[0], schemas, key, depth);
  if (schema.enum) return schema.enum[0];
  if (schema.type === "array") return [example(schema.items ?? {}, schemas, key, depth + 1)];
  if (schema.type === "object") {
    const fields = Object.entries(schema.properties ?? {});
    return Object.fromEntries(
      fields.map(([name, one]) => [name, example(one, schemas, name, depth + 1)]),
    );
  }
  return { string: "text", integer: 1, number: 0.5, boolean: true }[schema.type] ?? null;
}
