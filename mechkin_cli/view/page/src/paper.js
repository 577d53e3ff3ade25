// Printing: the canvas as a picture, in light colours, with all panels below it.

import { find } from "./dom.js";

export function preparePaper(theme, theatre) {
  const picture = find("#printed");
  // the canvas keeps its size on paper, where it is not laid out
  if (theatre) theatre.stage.keepsSize = () => theme.printing;
  theme.addEventListener("change", () => {
    picture.hidden = !theme.printing || !theatre;
    if (picture.hidden) return;
    theatre.stage.draw();
    picture.src = theatre.stage.renderer.domElement.toDataURL("image/png");
  });
}
