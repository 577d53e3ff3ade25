// Tabs: one panel at a time; on paper all of them.

import { element, find } from "../dom.js";

/** Tabs for panels by their ids; the first one added is open. */
export class Tabs {
  #buttons = new Map();

  constructor(host) {
    this.host = host;
  }

  add(id, text) {
    const button = element("button", { type: "button", role: "tab", id: `tab-${id}`, "aria-controls": id, on: { click: () => this.open(id) } }, text);
    this.#buttons.set(id, button);
    this.host.append(button);
    this.open([...this.#buttons.keys()][0]);
  }

  has(id) {
    return this.#buttons.has(id);
  }

  open(id) {
    this.opened = id;
    for (const [each, button] of this.#buttons) {
      button.setAttribute("aria-selected", String(each === id));
      find(`#${each}`).hidden = each !== id;
    }
  }
}
