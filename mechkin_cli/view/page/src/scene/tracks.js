// Curved grooves, slots and surfaces of joints: walls and troughs along a curve, shells over a surface.

import { BufferGeometry, Float32BufferAttribute, Vector3 } from "three";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { squareTo, vector } from "./vectors.js";

const CREASE = 0.6;
const SIDES = 8; // of a trough's round inside
const [INNER, OUTER] = [0.83, 1.1]; // of a trough, in joint sizes: the ball has 0.8
const THICK = 0.3; // of a shell

/** Walls beside a pin's slot in the plane square to `axis`, on both sides of its curve. */
export function addSlot(half, track, axis, u) {
  const walls = [-1, 1].map((side) => {
    const [near, far] = [side * 0.6 * u, side * 0.9 * u];
    const corners = [[near, -0.9 * u], [far, -0.9 * u], [far, 0.9 * u], [near, 0.9 * u]];
    return side > 0 ? corners : corners.reverse();
  });
  const { places, along } = courseOf(track);
  const frames = along.map((t) => [axis.clone().cross(t).normalize(), axis]);
  for (const outline of walls) half.body.add(swept(places, frames, outline, track.closed));
}

/** A trough along a groove, open away from the middle of its curve. */
export function addTrough(half, track, u) {
  const { places, along } = courseOf(track);
  const middle = places.reduce((sum, place) => sum.addScaledVector(place, 1 / places.length), new Vector3());
  let out = half.stem.clone().negate();
  const frames = along.map((t, k) => {
    const off = places[k].clone().sub(middle);
    const wish = track.closed && off.lengthSq() > 0 ? off : out;
    out = squareTo(t, wish);
    return [out, t.clone().cross(out)];
  });
  const round = (radius, from, to) => Array.from({ length: SIDES + 1 }, (_, k) => {
    const angle = from + ((to - from) * k) / SIDES;
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
  const outline = [...round(OUTER * u, Math.PI / 2, 1.5 * Math.PI), ...round(INNER * u, 1.5 * Math.PI, Math.PI / 2)];
  half.body.add(swept(places, frames, outline, track.closed));
}

/** A shell at the ball's radius from the surface of its centre, on the side of the link. */
export function addShell(half, track, u) {
  const rows = track.rows.map((row) => row.map(vector));
  const [last, end] = [rows.length - 1, rows[0].length - 1];
  const normals = rows.map((row, i) => row.map((_, k) => {
    const byU = rows[Math.min(i + 1, last)][k].clone().sub(rows[Math.max(i - 1, 0)][k]);
    const byV = row[Math.min(k + 1, end)].clone().sub(row[Math.max(k - 1, 0)]);
    return byU.cross(byV).normalize();
  }));
  const side = sideOf(rows, normals, half);
  const layer = (by) => rows.map((row, i) => row.map((place, k) => place.clone().addScaledVector(normals[i][k], side * by)));
  const [near, far] = [layer(0.8 * u), layer((0.8 + THICK) * u)];
  const points = [];
  const cell = (a, b, c, d, turned) => points.push(...(turned ? [a, c, b, a, d, c] : [a, b, c, a, c, d]));
  for (let i = 0; i < last; i += 1) {
    for (let k = 0; k < end; k += 1) {
      for (const [grid, turned] of [[near, side > 0], [far, side < 0]]) {
        cell(grid[i][k], grid[i + 1][k], grid[i + 1][k + 1], grid[i][k + 1], turned);
      }
    }
  }
  half.body.add(solid(points));
}

/** On which side of a surface its link is: that of the link's middle from the place next to the joint. */
function sideOf(rows, normals, half) {
  let [best, found] = [Infinity, 1];
  rows.forEach((row, i) => row.forEach((place, k) => {
    const apart = place.distanceToSquared(half.point);
    if (apart < best) [best, found] = [apart, normals[i][k].dot(half.stem) < 0 ? -1 : 1];
  }));
  return found;
}

/** Places of a curve and its directions there. */
function courseOf({ rows: [row], closed }) {
  const places = row.map(vector);
  const count = places.length;
  const at = (k) => (closed ? places[(k + count) % count] : places[Math.min(Math.max(k, 0), count - 1)]);
  return { places, along: places.map((_, k) => at(k + 1).clone().sub(at(k - 1)).normalize()) };
}

/** What a closed outline [[x, y], ...], counter-clockwise, sweeps along places with frames [x, y]. */
function swept(places, frames, outline, closed) {
  const rings = places.map((place, k) =>
    outline.map(([x, y]) => place.clone().addScaledVector(frames[k][0], x).addScaledVector(frames[k][1], y)),
  );
  const points = [];
  const count = outline.length;
  const sections = closed ? rings.length : rings.length - 1;
  for (let k = 0; k < sections; k += 1) {
    const [here, next] = [rings[k], rings[(k + 1) % rings.length]];
    for (let n = 0; n < count; n += 1) {
      const m = (n + 1) % count;
      points.push(here[n], next[m], next[n], here[n], here[m], next[m]);
    }
  }
  if (!closed) {
    // strips between the outline's halves close the ends
    for (const [ring, turned] of [[rings[0], false], [rings.at(-1), true]]) {
      for (let n = 0; n < count / 2 - 1; n += 1) {
        const [a, b, c, d] = [ring[n], ring[n + 1], ring[count - 2 - n], ring[count - 1 - n]];
        points.push(...(turned ? [a, b, c, a, c, d] : [a, c, b, a, d, c]));
      }
    }
  }
  return solid(points);
}

function solid(points) {
  const made = new BufferGeometry();
  made.setAttribute("position", new Float32BufferAttribute(points.flatMap((point) => point.toArray()), 3));
  made.computeVertexNormals();
  return toCreasedNormals(made, CREASE);
}
