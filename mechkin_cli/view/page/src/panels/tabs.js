// Tabs: one panel at a time; on paper all of them.

import { element, find } from "../dom.js";

/** Tabs for panels by their ids; the first one added is open. */
export class Tabs {
  #buttons = new Map();

  constructor(host) {
    this.host = host;
  }

  /** Adds a tab; `before` is the one that it stands in front of. */
  add(id, text, before = null) {
    const button = element("button", { type: "button", role: "tab", id: `tab-${id}`, "aria-controls": id, on: { click: () => this.open(id) } }, text);
    this.#buttons.set(id, button);
    this.host.insertBefore(button, this.#buttons.get(before) ?? null);
    if (this.#buttons.size === 1) this.open(id);
    else this.open(this.opened);
  }

  open(id) {
    this.opened = id;
    for (const [each, button] of this.#buttons) {
      button.setAttribute("aria-selected", String(each === id));
      find(`#${each}`).hidden = each !== id;
    }
  }
}
