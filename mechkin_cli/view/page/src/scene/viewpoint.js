// From where to look first: the side from which the mechanism covers most and hides itself least.

import { Box3, Vector3 } from "three";
import { reached } from "./shapes.js";
import { squareTo, vector } from "./vectors.js";
import { poseMatrix, slideStops } from "./travel.js";
import { reachedBy, reachedByDisc, reachedByScrew } from "./wheels.js";

const MOST_POSES = 60;
const TURNS = 24;
const HEIGHT = 0.45; // of the camera over the floor, in parts of its distance

/** Where the joints and the points come to in a branch. */
export function placesOf(data, branch) {
  const found = [];
  const shown = (link) => !data.links[link].hidden;
  const shapes = data.links.map(({ shape }) => reached(shape));
  data.wheels.forEach((wheel) => shapes[wheel.link].push(...reachedBy(wheel)));
  data.screws.forEach((screw) => shapes[screw.link].push(...reachedByScrew(screw)));
  for (const { links, places, beside } of data.cables) {
    links.forEach((link, k) => shapes[link].push(...rim(vector(places[k]), Math.abs(beside[k]))));
  }
  data.discs.forEach((disc) => shapes[disc.link].push(...reachedByDisc(disc)));
  for (const joint of data.joints) {
    const [point, axis] = [vector(joint.halves[0].point), vector(joint.halves[0].axis)];
    const ends = slideStops(joint, data.size).filter((end) => end !== null);
    shapes[joint.links[0]].push(...ends.map((end) => point.clone().addScaledVector(axis, end)));
  }
  for (const { links, track } of data.joints) if (track) shapes[links[1]].push(...track.rows.flat().filter((_, k) => k % 8 === 0).map(vector));
  const stride = Math.max(1, Math.ceil(branch.poseCount / MOST_POSES));
  for (let index = 0; index < branch.poseCount; index += stride) {
    const poses = data.links.map((_, link) => poseMatrix(branch.pose(index, link)));
    const add = (link, place) => shown(link) && found.push(vector(place).applyMatrix4(poses[link]));
    for (const joint of data.joints) joint.links.forEach((link, k) => add(link, joint.halves[k].point));
    for (const { link, place } of data.points) add(link, place);
    data.links.forEach((_, link) => shapes[link].forEach((place) => add(link, place.toArray())));
  }
  if (found.length === 0) found.push(vector(data.centre));
  return found;
}

/** The box about a pulley in the plane z. */
const rim = (centre, radius) =>
  radius > 0 ? [[1, 1], [1, -1], [-1, 1], [-1, -1]].map(([x, y]) => centre.clone().add(new Vector3(x * radius, y * radius, 0))) : [];

/** The diagonal of the box that holds places. */
export function diagonal(places) {
  const box = new Box3().setFromPoints(places);
  return box.min.distanceTo(box.max);
}

/** Corners of cubes of half width `room` about places: what the parts drawn there need. */
export function withRoom(places, room) {
  const thinned = places.length > 3000 ? places.filter((_, k) => k % Math.ceil(places.length / 3000) === 0) : places;
  const signs = [-room, room];
  return thinned.flatMap((place) =>
    signs.flatMap((x) => signs.flatMap((y) => signs.map((z) => place.clone().add(new Vector3(x, y, z))))));
}

/** The direction towards the first camera. */
export function firstDirection(data, places) {
  if (data.view?.camera) return vector(data.view.camera);
  if (data.planar) return new Vector3(0, 0, 1);
  const up = vector(data.up).normalize();
  const x = squareTo(up, new Vector3(1, 0, 0));
  const y = up.clone().cross(x);
  let [best, most] = [null, -1];
  for (let turn = 0; turn < TURNS; turn += 1) {
    // the first of equals is the usual one, from the right and before
    const angle = -Math.PI / 3 + (2 * Math.PI * turn) / TURNS;
    const back = x.clone().multiplyScalar(Math.cos(angle)).addScaledVector(y, Math.sin(angle))
      .addScaledVector(up, HEIGHT).normalize();
    const area = covered(places, back, up);
    if (area > 1.02 * most) [best, most] = [back, area];
  }
  return best;
}

/** A measure of the area that places cover: the determinant of their scatter as seen. */
function covered(places, back, up) {
  const right = up.clone().cross(back).normalize();
  const above = back.clone().cross(right);
  const seen = places.map((place) => [place.dot(right), place.dot(above)]);
  const mean = [0, 1].map((k) => seen.reduce((sum, each) => sum + each[k], 0) / seen.length);
  let [xx, xy, yy] = [0, 0, 0];
  for (const [a, b] of seen) {
    xx += (a - mean[0]) ** 2;
    xy += (a - mean[0]) * (b - mean[1]);
    yy += (b - mean[1]) ** 2;
  }
  return Math.sqrt(Math.max(0, xx * yy - xy * xy));
}
