// A rule of eslint: what a page shows comes from the Fluent files, so that it can be translated.
// It looks at templates of lit-html, at what is put into elements, and at sentences anywhere.

const HOLE = "\0"; // where a template has an expression
const WORD = /\p{L}{2}/u;
const SENTENCE = /^\p{Lu}[\p{L}\d-]+([,:]? [\p{L}\d].*|…)$/u;
const SHOWN = new Set(["textContent", "title", "ariaLabel", "placeholder", "alt"]);
const LABEL = /\s(?:aria-label|title|alt|placeholder|label)="([^"]*)"/g;
const NAMES =
  /\b(?:recon4|Mac OS|VLP-16 Hi-Res|EPSG|TOML|DXF|SHA-256|[cm]m|\w+\.(?:\w+|\0))(?!\w)/g;

/** Whether there are words besides names, which are the same in every language. */
const isShown = (text) => WORD.test(text.replace(NAMES, ""));

/** Texts of a template of lit-html: between its tags, and in attributes that label. */
function textsOf({ quasis }) {
  const whole = quasis.map(({ value }) => value.cooked).join(HOLE);
  const html = whole.replace(/<(code|kbd|pre)\b[^>]*>[^<]*<\/\1\s*>/g, "");
  const labels = [...html.matchAll(LABEL)].map(([, text]) => text);
  return [...html.split(/<[^>]*>/), ...labels];
}

const isMessageOfError = ({ parent }) =>
  parent.type === "NewExpression" && /Error$/.test(parent.callee.name ?? "");

export default {
  meta: { type: "problem", messages: { literal: "“{{text}}” is not from the texts: use t(…)" } },
  create(context) {
    const refuse = (node, text) =>
      context.report({
        node,
        messageId: "literal",
        data: { text: text.replaceAll(HOLE, "…").trim().slice(0, 60) },
      });
    const whole = (node, text) => {
      if (SENTENCE.test(text) && isShown(text) && !isMessageOfError(node)) refuse(node, text);
    };
    return {
      TaggedTemplateExpression(node) {
        if (node.tag.name !== "html") return;
        for (const text of textsOf(node.quasi)) if (isShown(text)) refuse(node, text);
      },
      TemplateLiteral(node) {
        if (node.parent.type !== "TaggedTemplateExpression")
          whole(node, node.quasis.map(({ value }) => value.cooked).join("0"));
      },
      Literal(node) {
        if (typeof node.value === "string") whole(node, node.value);
      },
      AssignmentExpression({ left, right }) {
        if (SHOWN.has(left.property?.name) && right.type === "Literal" && isShown(right.value))
          refuse(right, right.value);
      },
    };
  },
};
