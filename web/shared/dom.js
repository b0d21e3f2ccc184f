// Small helpers to make elements; text is always text, never HTML.

export function make(tag, props = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(props)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key in element && key !== "list") element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Replaces the children only if that changes what is seen, so that focus and selection stay. */
export function fill(element, ...children) {
  const fresh = make(element.localName, {}, ...children);
  if (fresh.innerHTML !== element.innerHTML) element.replaceChildren(...fresh.childNodes);
}

/** Runs an action of a button; a refusal is shown in words beside it. */
export async function attempt(message, action) {
  message.textContent = "";
  try {
    return await action();
  } catch (error) {
    message.textContent = error.message;
    return undefined;
  }
}
