// Printing: the stage as a picture, with its names and values, in light colours, with all panels below it.

import { element, find } from "./dom.js";

export function preparePaper(theme, theatre) {
  const picture = find("#printed");
  // the canvas keeps its size on paper, where it is not laid out
  if (theatre) theatre.stage.keepsSize = () => theme.printing;
  theme.addEventListener("change", () => {
    picture.hidden = !theme.printing || !theatre;
    if (picture.hidden) return;
    picture.src = pictureOf(theatre).toDataURL("image/png");
  });
}

/** A canvas with the stage as it is seen, and its names. */
export function pictureOf(theatre) {
  theatre.stage.draw();
  const { domElement } = theatre.stage.renderer;
  const sheet = element("canvas", { width: domElement.width, height: domElement.height });
  const brush = sheet.getContext("2d");
  brush.drawImage(domElement, 0, 0);
  theatre.labels.write(brush, domElement.width / theatre.stage.width, theatre.stage.background);
  return sheet;
}
