// The curves that are shown, as one SVG picture: a frame for each unit, with ticks, names and dashes.

import { told } from "../numbers.js";
import { escaped, short, svg } from "./drawings.js";

const [WIDTH, HEIGHT, LEFT, TOP, BELOW, RIGHT] = [760, 300, 78, 34, 42, 16];
const INK = "#3b424c";

/** @param plots  those of the panel: uPlot's, whose data and scales are read */
export function curvePicture(plots, title) {
  const parts = plots.map((plot, k) => `<g transform="translate(0 ${k * HEIGHT})">\n${frameOf(plot)}\n</g>`);
  return svg(`0 0 ${WIDTH} ${Math.max(1, plots.length) * HEIGHT}`, title, `<rect width="100%" height="100%" fill="#fff"/>\n<g font-family="sans-serif" font-size="12" fill="${INK}">\n${parts.join("\n")}\n</g>`);
}

function frameOf(plot) {
  const { x, y } = plot.scales;
  const [right, bottom] = [WIDTH - RIGHT, HEIGHT - BELOW];
  const across = (value) => LEFT + ((value - x.min) / (x.max - x.min || 1)) * (right - LEFT);
  const up = (value) => bottom - ((value - y.min) / (y.max - y.min || 1)) * (bottom - TOP);
  const parts = [`<rect x="${LEFT}" y="${TOP}" width="${right - LEFT}" height="${bottom - TOP}" fill="none" stroke="#c3c8d0"/>`];
  for (const value of ticks(x.min, x.max, 7)) {
    const at = short(across(value));
    parts.push(`<path d="M${at} ${TOP}V${bottom}" stroke="#e3e6ea"/><text x="${at}" y="${bottom + 16}" text-anchor="middle">${escaped(told(value, 4))}</text>`);
  }
  for (const value of ticks(y.min, y.max, 5)) {
    const at = short(up(value));
    parts.push(`<path d="M${LEFT} ${at}H${right}" stroke="#e3e6ea"/><text x="${LEFT - 6}" y="${at + 4}" text-anchor="end">${escaped(told(value, 4))}</text>`);
  }
  parts.push(`<text x="${right}" y="${HEIGHT - 8}" text-anchor="end">${escaped(plot.xName)}</text>`, `<text x="${LEFT}" y="${TOP - 20}">${escaped(plot.yName)}</text>`);
  const shown = plot.series.slice(1);
  const each = Math.max(90, (right - LEFT - 60) / Math.max(1, shown.length));
  shown.forEach((series, k) => {
    const dash = series.dash ? ` stroke-dasharray="${series.dash.join(" ")}"` : "";
    const colour = escaped(plot.columns[k].series.stroke);
    const points = pieces(plot.data[0], plot.data[k + 1]).map((piece) => piece.map(([a, b], n) => `${n === 0 ? "M" : "L"}${short(across(a))} ${short(up(b))}`).join("")).join("");
    parts.push(`<path d="${points}" fill="none" stroke="${colour}" stroke-width="${series.width}"${dash}/>`);
    const at = LEFT + k * each;
    parts.push(`<path d="M${at} ${TOP - 8}h18" stroke="${colour}" stroke-width="2"${dash}/><text x="${at + 22}" y="${TOP - 4}">${escaped(series.label)}</text>`);
  });
  return parts.join("\n");
}

/** Runs of places without a gap. */
function pieces(xs, ys) {
  const found = [[]];
  xs.forEach((x, k) => {
    if (ys[k] === null || ys[k] === undefined) found.push([]);
    else found.at(-1).push([x, ys[k]]);
  });
  return found.filter((piece) => piece.length > 0);
}

/** About `count` round numbers between two. */
function ticks(from, to, count) {
  const wished = (to - from) / count;
  if (!(wished > 0)) return [from];
  const power = 10 ** Math.floor(Math.log10(wished));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= wished);
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; k += 1) found.push(k * step);
  return found;
}
