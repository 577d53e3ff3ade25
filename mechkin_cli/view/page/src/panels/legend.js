// The names of the links in their colours; a click takes a link off the stage and puts it back.

import { linkColour } from "../colours.js";
import { element } from "../dom.js";

export function showLegend(host, data, theatre) {
  host.append(...data.links.map((link, index) => {
    const button = element("button", {
      type: "button", "aria-pressed": String(!link.hidden), style: { "--link": linkColour(link, index) },
      on: { click: () => {
        const on = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(on));
        theatre.setLinkVisible(index, on);
      } },
    }, link.name);
    return button;
  }));
}
