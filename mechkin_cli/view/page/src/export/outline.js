// The mechanism as lines in the plane of the picture, to scale: what SVG and DXF are written of.

import { Vector3 } from "three";
import { linkColour } from "../colours.js";
import { vector } from "../scene/vectors.js";
import { poseMatrix } from "../scene/travel.js";
import { curveThrough } from "../scene/between.js";

const PIN = 0.012; // radius of a joint's circle, in parts of the mechanism's size

/**
 * Lines and circles of the pose that is drawn, seen from the camera without perspective, in the file's unit of length.
 * @returns {{lines: [{layer, colour, points: [[x, y]], closed}], circles: [{layer, colour, centre, radius}]}}
 */
export function outlineOf(theatre) {
  const { drawn: data, mechanism, stage, state } = theatre;
  const [right, above] = [0, 1].map((k) => new Vector3().setFromMatrixColumn(stage.camera.matrixWorld, k));
  const flat = (place) => [place.dot(right), place.dot(above)].map((each) => Number(each.toPrecision(9)));
  const [lines, circles] = [[], []];
  const seen = (link) => mechanism.links[link].visible;
  data.links.forEach((link, index) => {
    if (!seen(index)) return;
    const colour = linkColour(link, index);
    for (const { points, closed } of strokesOf(link.shape)) {
      lines.push({ layer: link.name, colour, closed, points: points.map((place) => flat(mechanism.now(index, place))) });
    }
  });
  for (const { links, halves } of data.joints) {
    const k = seen(links[0]) ? 0 : 1;
    if (!seen(links[k])) continue;
    const [link] = [data.links[links[k]]];
    circles.push({ layer: "JOINTS", colour: linkColour(link, links[k]), centre: flat(mechanism.now(links[k], halves[k].point)), radius: PIN * theatre.size });
  }
  for (const disc of data.discs) {
    if (!seen(disc.link)) continue;
    const [x, y] = [vector(disc.x), vector(disc.axis).cross(vector(disc.x))];
    const places = disc.outline.map(([a, b]) => vector(disc.centre).addScaledVector(x, a).addScaledVector(y, b).toArray());
    lines.push({ layer: "CAMS", colour: linkColour(data.links[disc.link], disc.link), closed: true, points: places.map((place) => flat(mechanism.now(disc.link, place))) });
  }
  for (const wheel of data.wheels) {
    if (!seen(wheel.link) || wheel.reach || Math.abs(vector(wheel.axis).applyQuaternion(mechanism.links[wheel.link].quaternion).dot(right.clone().cross(above))) < 0.999) continue;
    circles.push({ layer: "WHEELS", colour: linkColour(data.links[wheel.link], wheel.link), centre: flat(mechanism.now(wheel.link, wheel.centre)), radius: wheel.radius });
  }
  for (const { link, place, path } of data.points) {
    if (!path || !theatre.shown.paths) continue;
    const { branch } = state;
    const places = Array.from({ length: branch.poseCount }, (_, index) => vector(place).applyMatrix4(poseMatrix(branch.pose(index, link))));
    if (places.length > 1) lines.push({ layer: "PATHS", colour: linkColour(data.links[link], link), closed: false, points: curveThrough(places).map(flat) });
  }
  return { lines, circles };
}

/** The lines that stand for a link: along a rod, round a plate, from the middle of a star. */
function strokesOf({ kind, points, centre }) {
  if (points.length < 2 || kind === "none" || kind === "wheel") return [];
  if (kind === "star") return points.map((point) => ({ points: [centre, point], closed: false }));
  if (kind === "plate") return [{ points: roundPlate(points), closed: true }];
  return [{ points, closed: false }];
}

/** The corners of a plate in their order about its middle. */
function roundPlate(points) {
  const places = points.map(vector);
  const middle = new Vector3();
  places.forEach((place) => middle.addScaledVector(place, 1 / places.length));
  const first = places[0].clone().sub(middle);
  const normal = places.slice(1).map((place) => first.clone().cross(place.clone().sub(middle))).sort((a, b) => b.lengthSq() - a.lengthSq())[0];
  const side = normal.clone().cross(first);
  const angle = (place) => Math.atan2(place.clone().sub(middle).dot(side) / side.length(), place.clone().sub(middle).dot(first) / first.length());
  return places.sort((a, b) => angle(a) - angle(b)).map((place) => place.toArray());
}
