// What the page tells the one that holds it in a frame, and what that one may ask: parameters and row, both ways.

import { written } from "./file_text.js";

/** Speaks with the parent window, if there is one, and with nobody else. */
export function speakWithParent({ state, dimensions }) {
  const { parent } = window;
  if (parent === window) return;
  let asked = false;
  const tellParameters = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      const { values, parameters } = dimensions;
      const texts = Object.fromEntries(parameters.map((each) => [each.name, written(each, values[each.name])]));
      post({ mechkin: "parameters", values, texts });
    });
  };
  // a page from a file has no origin that could be named; nothing in the messages is secret from who holds the page
  const post = (message) => parent.postMessage(message, "*");
  dimensions?.addEventListener("change", tellParameters);
  let row = state.row;
  state.watch(() => {
    if (state.row === row) return;
    row = state.row;
    post({ mechkin: "row", row });
  });
  window.addEventListener("message", ({ source, data }) => {
    if (source !== parent || typeof data !== "object" || data === null) return;
    if (data.mechkin === "set-row" && Number.isInteger(data.row)) state.seek(data.row);
    if (data.mechkin === "set-parameters" && typeof data.values === "object") dimensions?.setAll(data.values ?? {});
  });
}
