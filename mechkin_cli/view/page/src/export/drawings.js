// Drawings as files: DXF (R12, which every program reads) and SVG, of lines and circles in a plane.

const MARGIN = 0.04; // of a picture's size

// colours of DXF by their numbers, near which the page's lie
const DXF_COLOURS = [[1, 255, 0, 0], [2, 200, 200, 0], [3, 0, 160, 0], [4, 0, 170, 190], [5, 0, 0, 255], [6, 200, 0, 200], [8, 128, 128, 128], [30, 230, 120, 30]];

/** A DXF file of release 12; lengths are in the file's unit. */
export function dxfOf({ lines, circles }) {
  const layers = new Map();
  for (const { layer, colour } of [...lines, ...circles]) if (!layers.has(layer)) layers.set(layer, { name: layerName(layer, layers), colour: dxfColour(colour) });
  const pairs = [[0, "SECTION"], [2, "HEADER"], [9, "$ACADVER"], [1, "AC1009"], [0, "ENDSEC"]];
  pairs.push([0, "SECTION"], [2, "TABLES"], [0, "TABLE"], [2, "LAYER"], [70, layers.size]);
  for (const { name, colour } of layers.values()) pairs.push([0, "LAYER"], [2, name], [70, 0], [62, colour], [6, "CONTINUOUS"]);
  pairs.push([0, "ENDTAB"], [0, "ENDSEC"], [0, "SECTION"], [2, "ENTITIES"]);
  for (const { layer, points, closed } of lines) {
    const { name } = layers.get(layer);
    pairs.push([0, "POLYLINE"], [8, name], [66, 1], [70, closed ? 1 : 0], [10, "0.0"], [20, "0.0"], [30, "0.0"]);
    for (const [x, y] of points) pairs.push([0, "VERTEX"], [8, name], [10, real(x)], [20, real(y)], [30, "0.0"]);
    pairs.push([0, "SEQEND"], [8, name]);
  }
  for (const { layer, centre: [x, y], radius } of circles) {
    pairs.push([0, "CIRCLE"], [8, layers.get(layer).name], [10, real(x)], [20, real(y)], [30, "0.0"], [40, real(radius)]);
  }
  pairs.push([0, "ENDSEC"], [0, "EOF"]);
  return pairs.map(([code, value]) => `${code}\r\n${value}\r\n`).join("");
}

const real = (value) => (Number.isInteger(value) ? value.toFixed(1) : String(value));

/** Release 12 knows capitals, digits and a few signs. */
function layerName(text, taken) {
  const name = text.toUpperCase().replaceAll(/[^A-Z0-9_$-]/g, "_").slice(0, 28) || "LINK";
  const used = new Set([...taken.values()].map((each) => each.name));
  let found = name;
  for (let k = 2; used.has(found); k += 1) found = `${name}_${k}`;
  return found;
}

function dxfColour(colour) {
  const hex = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(colour);
  if (!hex) return 7;
  const rgb = hex.slice(1).map((part) => parseInt(part, 16));
  const off = ([, ...other]) => other.reduce((sum, each, k) => sum + (each - rgb[k]) ** 2, 0);
  return DXF_COLOURS.reduce((best, each) => (off(each) < off(best) ? each : best))[0];
}

/** An SVG picture, one unit of which is one unit of length of the file. */
export function svgOf({ lines, circles }, { unit, title }) {
  const every = [...lines.flatMap(({ points }) => points), ...circles.flatMap(({ centre: [x, y], radius }) => [[x - radius, y - radius], [x + radius, y + radius]])];
  const [xs, ys] = [0, 1].map((k) => every.map((each) => each[k]));
  const [left, right, low, high] = [least(xs), most(xs), least(ys), most(ys)];
  const size = Math.max(right - left, high - low) || 1;
  const margin = MARGIN * size;
  const box = [left - margin, -high - margin, right - left + 2 * margin, high - low + 2 * margin].map(short).join(" ");
  const stroke = short(0.006 * size);
  const shapes = [
    ...lines.map(({ points, closed, colour, layer }) =>
      `<${closed ? "polygon" : "polyline"} points="${points.map(([x, y]) => `${short(x)},${short(-y)}`).join(" ")}" stroke="${escaped(colour)}"><title>${escaped(layer)}</title></${closed ? "polygon" : "polyline"}>`),
    ...circles.map(({ centre: [x, y], radius, colour }) => `<circle cx="${short(x)}" cy="${short(-y)}" r="${short(radius)}" stroke="${escaped(colour)}"/>`),
  ];
  return svg(box, title, `<desc>Lengths in ${escaped(unit)}</desc>\n<g fill="none" stroke-width="${stroke}" stroke-linejoin="round" stroke-linecap="round">\n${shapes.join("\n")}\n</g>`);
}

/** The text of an SVG picture. */
export function svg(box, title, content) {
  return `<?xml version="1.0" encoding="UTF-8"?>\n<svg xmlns="http://www.w3.org/2000/svg" viewBox="${box}">\n<title>${escaped(title)}</title>\n${content}\n</svg>\n`;
}

const SIGNS = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };

/** A text as it stands in XML, without what XML cannot hold. */
export const escaped = (text) => String(text).replaceAll(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "").replaceAll(/[&<>"']/g, (sign) => SIGNS[sign]);
export const short = (value) => Number(value.toPrecision(7));
const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);
const most = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
