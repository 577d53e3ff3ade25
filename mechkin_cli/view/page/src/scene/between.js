// Between computed poses: a picture may pass smoothly where they are near, only while it plays; paths bend through them.

import { Vector3 } from "three";

const CORNER = Math.cos(Math.PI / 3); // chords that turn by more than 60 degrees meet in a corner
const FINEST = Math.PI / 60; // the turn of a curve that is drawn as one line
const CLOSED = 1e-6; // of a path's length: nearer ends are one place
const MOST_TURN = Math.cos((15 * Math.PI) / 180 / 2);

/** {index, next, share} of the poses to draw at a place; `share` is 0 where a computed pose is drawn. */
export function posesAt(branch, place) {
  const index = branch.poseNear(Math.round(place));
  if (Number.isInteger(place) || index < 0) return { index, next: index, share: 0 };
  const rows = branch.poseRows;
  const low = rows[index] <= place ? index : index - 1;
  const high = low + 1;
  if (low < 0 || high >= rows.length || !joined(branch, low)) return { index, next: index, share: 0 };
  return { index: low, next: high, share: (place - rows[low]) / (rows[high] - rows[low]) };
}

/** Whether nothing lies between a pose and the next: no row without solution, no large turn. */
function joined(branch, low) {
  const rows = branch.poseRows;
  const stride = Math.max(1, Math.ceil(branch.rows / rows.length)) + 1;
  if (rows[low + 1] - rows[low] > stride) return false;
  for (let link = 0; link < branch.linkCount; link += 1) {
    const [a, b] = [branch.pose(low, link).q, branch.pose(low + 1, link).q];
    if (Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]) < MOST_TURN) return false;
  }
  return true;
}

/**
 * A curve through places, in so many lines that it looks smooth: between two places a cubic whose directions at them are those
 * of circles through three, so that circles come out as circles; straight beside corners.
 */
export function curveThrough(places) {
  const chords = places.slice(1).map((place, k) => place.clone().sub(places[k])).filter((chord) => chord.lengthSq() > 0);
  if (chords.length < 2) return places;
  const corners = places.filter((place, k) => k === 0 || place.distanceToSquared(places[k - 1]) > 0);
  const lengths = chords.map((chord) => chord.length());
  const along = chords.map((chord, k) => chord.clone().divideScalar(lengths[k]));
  const count = chords.length;
  const whole = lengths.reduce((sum, each) => sum + each, 0);
  const closed = corners[0].distanceTo(corners[count]) < CLOSED * whole;
  const directions = corners.map((_, k) => {
    const [before, after] = closed ? [(k - 1 + count) % count, k % count] : [k - 1, k];
    if (before < 0 || after >= count || along[before].dot(along[after]) < CORNER) return null;
    return along[before].clone().multiplyScalar(lengths[after]).addScaledVector(along[after], lengths[before]).normalize();
  });
  const curve = [corners[0]];
  for (let k = 0; k < count; k += 1) {
    // an end without a direction of its own has the other's, mirrored, as a circle does
    const start = directions[k] ?? mirrored(directions[k + 1], along[k]);
    const end = directions[k + 1] ?? mirrored(directions[k], along[k]);
    curve.push(...arc(corners[k], corners[k + 1], start, end, along[k], lengths[k]), corners[k + 1]);
  }
  return curve;
}

const mirrored = (direction, along) => direction?.clone().negate().addScaledVector(along, 2 * direction.dot(along));

/** Places between two of a curve; none where it is straight. */
function arc(from, to, start, end, along, length) {
  if (!start || !end) return [];
  const handles = [start, end].map((direction) => (2 * length) / (3 * (1 + direction.dot(along))));
  const points = [from, from.clone().addScaledVector(start, handles[0]), to.clone().addScaledVector(end, -handles[1]), to];
  const turn = start.angleTo(along) + end.angleTo(along);
  const parts = Math.ceil(turn / FINEST);
  return Array.from({ length: Math.max(0, parts - 1) }, (_, k) => {
    const t = (k + 1) / parts;
    const weights = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3];
    return points.reduce((sum, point, n) => sum.addScaledVector(point, weights[n]), new Vector3());
  });
}
