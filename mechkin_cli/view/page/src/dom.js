// Elements of the page. Texts go in as text nodes only: names come from files that anyone may have written.

/**
 * An element with properties and children.
 * @param {string} tag  as "button.play": a tag and classes
 * @param {object} [properties]  `on: {click: f}`, `style: {...}`, `data: {...}` or attributes
 * @param {...(Node|string|number)} children  anything that is no node becomes text
 */
export function element(tag, properties = {}, ...children) {
  const [name, ...classes] = tag.split(".");
  const made = document.createElement(name);
  made.classList.add(...classes);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "on") {
      for (const [event, listener] of Object.entries(value)) made.addEventListener(event, listener);
    } else if (key === "style") {
      for (const [rule, setting] of Object.entries(value)) made.style.setProperty(rule, setting);
    } else if (key === "data") {
      Object.assign(made.dataset, value);
    } else if (typeof value === "boolean") {
      made.toggleAttribute(key, value);
    } else {
      made.setAttribute(key, value);
    }
  }
  made.append(...children.map((child) => (child instanceof Node ? child : String(child))));
  return made;
}

/** A choice among texts; `onChange(index)` hears of the user's. */
export function choice(label, texts, onChange) {
  const made = element("select", { "aria-label": label, title: label });
  texts.forEach((text, index) => made.append(element("option", { value: index }, text)));
  made.addEventListener("change", () => onChange(Number(made.value)));
  return made;
}

/** A labelled check box; `onChange(checked)` hears of the user's. */
export function tick(label, checked, onChange) {
  const box = element("input", { type: "checkbox", checked });
  box.addEventListener("change", () => onChange(box.checked));
  return element("label.tick", {}, box, element("span", {}, label));
}

/** What `find` gives on the page, which has it. */
export const find = (selector) => document.querySelector(selector);
