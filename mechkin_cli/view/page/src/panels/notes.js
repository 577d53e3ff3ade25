// What mechkin said of the file, what it assumed, and how this page is used.

import { element } from "../dom.js";
import { KEYS } from "../keyboard.js";

/** Notes, warnings and assumptions in `host`; gives how many notes there are. */
export function showNotes(host, data) {
  const notes = data.notes ?? [];
  const assumed = data.assumed ?? [];
  if (notes.length === 0) host.append(element("p.empty", {}, "There are no notes."));
  host.append(element("ul.notes", {}, ...notes.map(({ severity, text, place }) =>
    element("li", { data: { severity } }, element("b", {}, severity), element("span", {}, text), element("small", {}, place ?? "")))));
  if (assumed.length > 0) {
    host.append(element("h3", {}, "Assumed"), element("ul.assumed", {}, ...assumed.map((text) => element("li", {}, text))));
  }
  return notes.length;
}

/** Keys, fingers and marks. */
export function showHelp(host, data) {
  host.append(
    element("h3", {}, "Keys"),
    element("dl.keys", {}, ...KEYS.flatMap(([keys, does]) => [
      element("dt", {}, ...keys.split(" ").map((key) => element("kbd", {}, key))), element("dd", {}, does)])),
    element("h3", {}, "Mouse and fingers"),
    element("ul", {},
      element("li", {}, "Drag turns the view, wheel or two fingers zoom, right button or two fingers move it."),
      element("li", {}, "A click on a curve or on a row of a table shows that row; dragging over curves zooms, a double click shows all again."),
      element("li", {}, "A click on a link's name hides it.")),
    element("h3", {}, "What is drawn"),
    element("ul", {},
      element("li", {}, "Each half of a joint has the colour of its link. The size of joints and rods is not to scale unless the file gives it; places, axes, leads and travels are."),
      element("li", {}, "Forces have one head, moments two, along their axis by the right-hand rule. What is much longer than usual is cut and pale."),
      element("li", {}, "Rows are drawn as computed. While it plays, the picture passes smoothly between rows that are near each other.")),
    element("p.made", {}, `Written by ${data.program ?? "mechkin"}; works without a network.`),
  );
}
