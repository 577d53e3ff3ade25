// The shapes of links between their joints: rods, thin plates, stars.

import { Path, Shape, Vector2, Vector3 } from "three";
import { ball, bar, drawnOut } from "./parts.js";
import { frame, squareTo, vector } from "./vectors.js";

const ROD = 0.36; // radius of a rod in parts of the joints' size
const RIM = 0.75; // what a plate reaches beyond its points

/** Adds a link's shape, as the data gives it, to its body. */
export function addShape(body, shape, unit) {
  const points = shape.points.map(vector);
  if (shape.kind === "rod") {
    points.slice(1).forEach((point, k) => addRod(body, points[k], point, unit));
  } else if (shape.kind === "star") {
    const centre = vector(shape.centre);
    points.forEach((point) => addRod(body, centre, point, unit));
    if (points.length > 2) body.add(ball(1.3 * ROD * unit).translate(...centre.toArray()));
  } else if (shape.kind === "plate") {
    addPlate(body, points, vector(shape.normal), unit);
  }
}

function addRod(body, from, to, unit) {
  const along = to.clone().sub(from);
  const length = along.length();
  if (length < 1e-3 * unit) return;
  body.add(bar(ROD * unit, 0, length, 18), frame(from, along));
}

/** The hull of the points, grown by a rim and rounded, drawn out to a thin plate. */
function addPlate(body, points, normal, unit) {
  const centre = new Vector3();
  points.forEach((point) => centre.addScaledVector(point, 1 / points.length));
  const z = normal.clone().normalize();
  const x = squareTo(z, points[0].clone().sub(centre));
  const y = z.clone().cross(x);
  const flat = points.map((point) => {
    const off = point.clone().sub(centre);
    return new Vector2(off.dot(x), off.dot(y));
  });
  const hull = convexHull(flat);
  const outline = rounded(hull, RIM * unit);
  if (hull.length > 2) {
    const inside = opening(hull, 0.9 * unit);
    if (inside) outline.holes.push(inside);
  }
  body.add(drawnOut(outline, -0.2 * unit, 0.2 * unit), frame(centre, z, x));
}

/** The corners of the convex hull, counterclockwise (Andrew's monotone chain). */
export function convexHull(points) {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const turn = (a, b, c) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);

/** The outline at `rim` about a convex hull. */
function rounded(hull, rim) {
  const outline = new Shape();
  hull.forEach((corner, k) => {
    const before = hull.at(k - 1);
    const after = hull[(k + 1) % hull.length];
    const from = Math.atan2(corner.y - before.y, corner.x - before.x) - Math.PI / 2;
    const to = Math.atan2(after.y - corner.y, after.x - corner.x) - Math.PI / 2;
    outline.absarc(corner.x, corner.y, rim, from, to < from ? to + 2 * Math.PI : to, false);
  });
  return outline;
}

/** An opening in a plate that is wide enough for one, so that what is behind shows; null where it is not. */
function opening(hull, margin) {
  const middle = hull.reduce((sum, each) => sum.add(each), new Vector2()).divideScalar(hull.length);
  const inner = hull.map((corner, k) => {
    const before = hull.at(k - 1).clone().sub(corner).normalize();
    const after = hull[(k + 1) % hull.length].clone().sub(corner).normalize();
    const sine = Math.abs(before.x * after.y - before.y * after.x);
    const inwards = before.add(after).divideScalar(Math.max(sine, 1e-3));
    return corner.clone().addScaledVector(inwards, margin);
  });
  const valid = inner.every((point, k) => {
    const next = inner[(k + 1) % inner.length].clone().sub(point);
    const edge = hull[(k + 1) % hull.length].clone().sub(hull[k]);
    return next.dot(edge) > 0.2 * edge.lengthSq() && turn(point, inner[(k + 1) % inner.length], middle) > 0;
  });
  return valid ? new Path(inner.reverse()) : null;
}
