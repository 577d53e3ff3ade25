// Solid parts in their own frames, z along the part's axis: what joints and links are put together of.

import {
  BoxGeometry, BufferGeometry, CylinderGeometry, ExtrudeGeometry, Float32BufferAttribute,
  LatheGeometry, Path, Shape, SphereGeometry, Vector2,
} from "three";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";

const ROUND = 28; // sides of what is round
const CREASE = 0.6;
const MOST_TURNS = 300;

const MOST_KEPT = 600;
const kept = new Map();

/** A part that was made before, or made now: nobody changes it. The oldest ones are forgotten. */
export function once(make, name) {
  return (...sizes) => {
    const key = `${name} ${JSON.stringify(sizes)}`;
    let part = kept.get(key);
    if (part) kept.delete(key);
    else part = make(...sizes);
    if (kept.size >= MOST_KEPT) kept.delete(kept.keys().next().value);
    kept.set(key, part); // as the youngest
    return part;
  };
}

const turned = (geometry) => geometry.rotateX(Math.PI / 2);

/** A round bar from z = `from` to `to`. */
export const bar = once((radius, from, to, sides = ROUND) =>
  turned(new CylinderGeometry(radius, radius, to - from, sides)).translate(0, 0, (from + to) / 2), "bar");

export const ball = once((radius) => turned(new SphereGeometry(radius, ROUND, ROUND / 2)), "ball");

/** A box from corner to corner. */
export const block = once((low, high) =>
  new BoxGeometry(...high.map((value, k) => value - low[k])).translate(
    ...high.map((value, k) => (value + low[k]) / 2),
  ), "block");

/** What a closed outline [[radius, z], ...] sweeps about z. */
export const turnedOutline = once((outline, angle = 2 * Math.PI, start = 0) => {
  const points = [...outline, outline[0]].map(([radius, z]) => new Vector2(radius, z));
  const sides = Math.max(3, Math.round((ROUND * angle) / (2 * Math.PI)));
  return toCreasedNormals(turned(new LatheGeometry(points, sides, start, angle)), CREASE);
}, "turned outline");

/** A sleeve about z. */
export const sleeve = (inner, outer, from, to) =>
  turnedOutline([[inner, from], [outer, from], [outer, to], [inner, to]]);

/** A spherical shell about z between two angles from the pole +z. */
export function shell(inner, outer, from, to) {
  const outline = [];
  const steps = 10;
  const at = (radius, k) => {
    const angle = from + ((to - from) * k) / steps;
    return [radius * Math.sin(angle), radius * Math.cos(angle)];
  };
  for (let k = 0; k <= steps; k += 1) outline.push(at(outer, k));
  for (let k = steps; k >= 0; k -= 1) outline.push(at(inner, k));
  // three's lathe turns an outline outside in where it runs the other way
  return turnedOutline(outline.reverse());
}

/** An outline in x and y, with a hole if one is given, drawn out along z. */
export function drawnOut(shape, from, to) {
  const { shape: outline, holes } = shape.extractPoints(12);
  return drawnOutline([outline, ...holes].map((points) => points.flatMap(({ x, y }) => [x, y])), from, to);
}

const drawnOutline = once((outlines, from, to) => {
  const [outline, ...holes] = outlines.map((each) => Array.from({ length: each.length / 2 }, (_, k) => new Vector2(each[2 * k], each[2 * k + 1])));
  const shape = new Shape(outline);
  shape.holes = holes.map((hole) => new Path(hole));
  const made = new ExtrudeGeometry(shape, { depth: to - from, bevelEnabled: false });
  return toCreasedNormals(made.translate(0, 0, from), CREASE);
}, "drawn outline");

/** A shape with straight sides. */
export const polygon = (points) => new Shape(points.map(([x, y]) => new Vector2(x, y)));

/** A square tube of half width `outer` with a square opening, or a round one. */
export function squareTube(inner, outer, from, to, round = false) {
  const shape = polygon([[-outer, -outer], [outer, -outer], [outer, outer], [-outer, outer]]);
  const hole = new Path();
  if (round) hole.absarc(0, 0, inner, 0, 2 * Math.PI, true);
  else hole.setFromPoints([[-inner, -inner], [-inner, inner], [inner, inner], [inner, -inner]].map(([x, y]) => new Vector2(x, y)));
  shape.holes.push(hole);
  return drawnOut(shape, from, to);
}

/** A hexagonal nut about z. */
export function nut(inner, outer, from, to) {
  const corners = Array.from({ length: 6 }, (_, k) => (k * Math.PI) / 3);
  const shape = polygon(corners.map((angle) => [outer * Math.cos(angle), outer * Math.sin(angle)]));
  shape.holes.push(new Path().absarc(0, 0, inner, 0, 2 * Math.PI, true));
  return drawnOut(shape, from, to);
}

/** A trough along z, open towards +x: of a pipe all but `opening` radians. */
export function trough(inner, outer, from, to, opening = Math.PI) {
  const shape = new Shape();
  shape.absarc(0, 0, outer, opening / 2, 2 * Math.PI - opening / 2, false);
  shape.absarc(0, 0, inner, 2 * Math.PI - opening / 2, opening / 2, true);
  return drawnOut(shape, from, to);
}

/** The ridges of a thread of true lead about z; as many starts as make them lie about `spacing` apart. */
export const thread = once((core, height, lead, spacing, from, to) => {
  const starts = Math.max(1, Math.round(Math.abs(lead) / spacing));
  const turns = Math.min(MOST_TURNS, (to - from) / Math.abs(lead));
  const half = Math.min(spacing, Math.abs(lead) / starts) * 0.32;
  const steps = Math.max(4, Math.ceil(turns * (turns > 60 ? 12 : 24)));
  const points = [];
  for (let start = 0; start < starts; start += 1) {
    const place = (step, radius, shift) => {
      const angle = 2 * Math.PI * (start / starts + (Math.sign(lead) * turns * step) / steps);
      const z = from + (Math.abs(lead) * turns * step) / steps + shift;
      return [radius * Math.cos(angle), radius * Math.sin(angle), Math.min(to, Math.max(from, z))];
    };
    for (let step = 0; step < steps; step += 1) {
      const [a, b, c] = [place(step, core, -half), place(step, core + height, 0), place(step, core, half)];
      const [d, e, f] = [
        place(step + 1, core, -half), place(step + 1, core + height, 0), place(step + 1, core, half),
      ];
      const faces = [a, d, b, d, e, b, b, e, c, e, f, c];
      points.push(...(lead > 0 ? faces : faces.reverse()).flat());
    }
  }
  const made = new BufferGeometry();
  made.setAttribute("position", new Float32BufferAttribute(points, 3));
  made.computeVertexNormals();
  return toCreasedNormals(made, CREASE);
}, "thread");
