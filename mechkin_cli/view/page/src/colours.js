// Colours: of links, verdicts, marks and curves, chosen to be told apart on light and dark ground.

const GROUND = "#8b929c";
const LINKS = [
  "#3b82d6", "#e5782e", "#2fa36b", "#c94f7c", "#8b6fd0", "#c2a01d", "#29a0b1", "#b0603a",
  "#6f9a2b", "#d65555", "#5768c9", "#a64fb0",
];
const GOOD = "#2fa36b";
const DOUBTFUL = "#d9a21b";
const BAD = "#d64545";

const CURVES = [
  "#3b82d6", "#e5782e", "#2fa36b", "#c94f7c", "#8b6fd0", "#29a0b1", "#c2a01d", "#b0603a",
];

/** The colour of a curve, or of a mode that is compared, by its number. */
export function curveColour(index) {
  return CURVES[index] ?? spread(index, 52);
}

export const MARKS = { "dead-centre": "#d64545", "branch-point": "#8b6fd0", event: "#29a0b1" };

export const ARROWS = { force: "#d6303f", moment: "#7a43d1" };

/** A colour that the file may have given, if it is one, else the link's own. */
export function linkColour(link, index) {
  if (/^#[0-9a-f]{6}$/i.test(link.colour ?? "")) return link.colour;
  if (index === 0) return GROUND;
  if (index <= LINKS.length) return LINKS[index - 1];
  return spread(index, 48);
}

/** Beyond a list, hues by the golden angle lie as far from each other as they can. */
function spread(index, saturation) {
  const hue = (137.508 * index) % 360;
  return `hsl(${hue.toFixed(1)}, ${saturation}%, ${index % 2 ? 42 : 56}%)`;
}

/** Colours of rows that are ok, have a position with a reservation, have none. */
export const DOUBTS = [GOOD, DOUBTFUL, BAD];
