// What the page tells the one that holds it in a frame, and what that one may ask: parameters and row, both ways.

import { written } from "./file_text.js";

/** Speaks with the parent window, if there is one, and with nobody else. */
export class ParentWindow {
  constructor(state) {
    this.dimensions = null;
    const { parent } = window;
    if (parent === window) return;
    this.parent = parent;
    let { row } = state;
    state.watch(() => {
      if (state.row === row) return;
      ({ row } = state);
      this.#post({ mechkin: "row", row });
    });
    window.addEventListener("message", ({ source, data }) => {
      if (source !== parent || typeof data !== "object" || data === null) return;
      if (data.mechkin === "set-row" && Number.isInteger(data.row)) {
        state.seek(data.row);
        if (state.row !== data.row) this.#post({ mechkin: "row", row: state.row }); // there is no such row
      }
      if (data.mechkin === "set-parameters" && typeof data.values === "object") this.dimensions?.setAll(data.values ?? {});
    });
  }

  /** Tells of changes of dimensions from now on. */
  follow(dimensions) {
    this.dimensions = dimensions;
    if (this.parent) dimensions.addEventListener("change", () => this.#tellParameters());
  }

  #tellParameters() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      const { values, parameters } = this.dimensions;
      const texts = Object.fromEntries(parameters.map((each) => [each.name, written(each, values[each.name])]));
      this.#post({ mechkin: "parameters", values, texts });
    });
  }

  /** A page from a file has no origin that could be named; nothing in the messages is secret from who holds the page. */
  #post(message) {
    this.parent.postMessage(message, "*");
  }
}
