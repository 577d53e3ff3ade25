// The shapes of links between their joints: rods, thin plates, stars, cylinders, wheels.

import { Path, Shape, Vector2, Vector3 } from "three";
import { ball, bar, drawnOut, sleeve, turnedOutline } from "./parts.js";
import { frame, squareTo, vector } from "./vectors.js";

const ROD = 0.36; // radius of a rod in parts of the joints' size
const RIM = 0.75; // what a plate reaches beyond its points
export const TUBE = 1.25; // radius of a cylinder in parts of the joints' size
export const BORE = 0.78; // of its radius
const SPOKES = 5;

/** Adds a link's shape, as the data gives it, to its body. */
export function addShape(body, shape, unit) {
  const points = shape.points.map(vector);
  if (shape.kind === "rod") {
    points.slice(1).forEach((point, k) => addRod(body, points[k], point, unit, shape.radius));
  } else if (shape.kind === "star") {
    const centre = vector(shape.centre);
    points.forEach((point) => addRod(body, centre, point, unit));
    if (points.length > 2) body.add(ball(1.3 * ROD * unit).clone().translate(...centre.toArray()));
  } else if (shape.kind === "plate") {
    addPlate(body, points, vector(shape.normal), unit);
  } else if (shape.kind === "cylinder") {
    addCylinder(body, ...points, shape.radius ?? TUBE * unit);
  } else if (shape.kind === "wheel") {
    addWheel(body, points[0], vector(shape.normal), shape.radius, shape.width / 2);
  }
}

/** Places that a shape reaches, up to the thickness that the page chooses. */
export function reached(shape) {
  if (shape.kind !== "wheel") return shape.points.map(vector);
  const on = frame(vector(shape.points[0]), vector(shape.normal));
  const corners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-0.5, 0.5].map((z) => [x, y, z])));
  return corners.map(([x, y, z]) => new Vector3(x * shape.radius, y * shape.radius, z * shape.width).applyMatrix4(on));
}

function addRod(body, from, to, unit, radius) {
  const along = to.clone().sub(from);
  const length = along.length();
  if (length < 1e-3 * unit) return;
  body.add(bar(radius ?? ROD * unit, 0, length, 18), frame(from, along));
}

/** A tube that is closed at `from` and open at `to`, where what slides in it goes in. */
function addCylinder(body, from, to, radius) {
  const along = to.clone().sub(from);
  const length = along.length();
  const inner = BORE * radius;
  const bottom = Math.min(radius - inner, length / 2);
  const cup = [[0, 0], [radius, 0], [radius, length], [inner, length], [inner, bottom], [0, bottom]];
  body.add(turnedOutline(cup), frame(from, along));
}

/** A rim about the axis with a hub and spokes; one that is wider than open is a roller. */
function addWheel(body, centre, axis, radius, half) {
  const on = frame(centre, axis);
  const [hub, rim] = [0.22 * radius, 0.82 * radius];
  if (2 * half > radius) {
    body.add(bar(radius, -half, half), on);
    return;
  }
  body.add(sleeve(rim, radius, -half, half), on);
  body.add(bar(hub, -half, half), on);
  for (let k = 0; k < SPOKES; k += 1) {
    const along = new Vector3(1, 0, 0).applyAxisAngle(new Vector3(0, 0, 1), (2 * Math.PI * k) / SPOKES);
    const spoke = frame(new Vector3(), along, new Vector3(0, 0, 1));
    body.add(bar(Math.min(0.6 * half, 0.07 * radius), 0.9 * hub, 1.02 * rim, 12), on.clone().multiply(spoke));
  }
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
