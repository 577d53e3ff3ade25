// Cables over points, pulleys and drums: lines that every pose lays anew, and the pulleys they run over.

import { Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { bar } from "./parts.js";
import { vector } from "./vectors.js";

const INK = "#4b525c";
const SIDES = 48; // of a full turn
const ALONG = new Vector3(0, 0, 1);
const [WIRE, PULLEY] = [0.14, 0.5]; // radius of a cable and half the width of a pulley, in joint sizes

/** Centres and axes of the pulleys at a cable's places, as `cable_pulleys` of the small pictures: one that swivels turns to
 * the place after it, or before it where the cable leaves along its line; a free one (2) to both. */
function pulleys(places, beside, axes, swivels) {
  const [centres, turned] = [[...places], [...axes]];
  swivels.forEach((way, k) => {
    if (way === 2) turned[k] = places[k - 1].clone().sub(places[k]).cross(places[k + 1].clone().sub(places[k])).normalize();
    if (way === 0 || way === 2) return;
    const out = squared(places[k + way].clone().sub(places[k]), axes[k]).normalize();
    centres[k] = places[k].clone().addScaledVector(out, Math.abs(beside[k]));
    turned[k] = out.cross(axes[k]);
  });
  return [centres, turned];
}

const squared = (each, axis) => each.addScaledVector(axis, -each.dot(axis));

/** The line of a cable past places, `beside` to the left of each against its axis, as `cable_line` of the small pictures. */
export function cableLine(places, beside, axes, swivels) {
  const [centres, turned] = pulleys(places, beside, axes, swivels);
  const line = beside[0] === 0 ? [centres[0]] : [];
  for (let k = 0; k + 1 < places.length; k++) {
    let [one, other, near, far] = [centres[k], centres[k + 1], beside[k], beside[k + 1]];
    // on its line a swivelling pulley is a point
    if (swivels[k] === -1) [one, near] = [places[k], 0];
    if (swivels[k + 1] === 1) [other, far] = [places[k + 1], 0];
    let [start, end] = [one, other];
    if (near !== 0 || far !== 0) {
      const axis = near !== 0 ? turned[k] : turned[k + 1];
      if (near !== 0 && far !== 0 && axis.dot(turned[k + 1]) < 0) far = -far;
      const apart = squared(other.clone().sub(one), axis);
      const square = apart.lengthSq();
      const by = near - far;
      const length = Math.sqrt(Math.max(square - by * by, 0));
      const along = apart.clone().multiplyScalar(length).addScaledVector(axis.clone().cross(apart), -by).divideScalar(square);
      const left = axis.clone().cross(along);
      start = one.clone().addScaledVector(left, near);
      end = other.clone().addScaledVector(left, far);
    }
    if (beside[k] !== 0) line.push(...(k > 0 ? wound(centres[k], line.at(-1), start, beside[k], turned[k]) : [start]));
    line.push(end);
  }
  return line;
}

/** Places on a pulley: clockwise about its axis where it is passed on its left. */
function wound(centre, first, last, beside, axis) {
  const x = first.clone().sub(centre);
  const y = axis.clone().cross(x).multiplyScalar(beside > 0 ? -1 : 1);
  const to = last.clone().sub(centre);
  const turn = (Math.atan2(to.dot(y), to.dot(x)) + 2 * Math.PI) % (2 * Math.PI);
  const steps = Math.max(1, Math.ceil((turn * SIDES) / (2 * Math.PI)));
  return Array.from({ length: steps }, (_, k) => {
    const now = (turn * (k + 1)) / steps;
    return centre.clone().addScaledVector(x, Math.cos(now)).addScaledVector(y, Math.sin(now));
  });
}

/** The cables of a mechanism. */
export class Cables {
  /** @param unit  the size of a joint */
  constructor(cables, unit) {
    this.cables = cables;
    this.unit = unit;
    this.object = new Group();
    this.material = new MeshStandardMaterial({ color: INK, roughness: 0.6 });
    this.wire = bar(WIRE * unit, 0, 1, 8);
    this.pieces = cables.map(() => []);
    this.wheels = cables.map(({ beside }) => {
      const largest = Math.max(...beside.map(Math.abs));
      return beside.map((each) => {
        if (each === 0) return null;
        // smaller ones are wider, so that two on one shaft are both seen
        const half = PULLEY * unit * (2 - Math.abs(each) / largest);
        const wheel = new Mesh(bar(Math.abs(each) - WIRE * unit, -half, half, SIDES), this.material);
        this.object.add(wheel);
        return wheel;
      });
    });
  }

  /** Lays them where the mechanism has their places now. */
  show(mechanism) {
    this.cables.forEach(({ links, places, beside, axes, swivels }, n) => {
      const now = places.map((place, k) => mechanism.now(links[k], place));
      const turned = axes.map((axis, k) => vector(axis).applyQuaternion(mechanism.links[links[k]].quaternion));
      const [centres, about] = pulleys(now, beside, turned, swivels);
      this.wheels[n].forEach((wheel, k) => {
        wheel?.position.copy(centres[k]);
        wheel?.quaternion.setFromUnitVectors(ALONG, about[k]);
      });
      this.#lay(this.pieces[n], cableLine(now, beside, turned, swivels));
    });
  }

  #lay(pieces, line) {
    while (pieces.length < line.length - 1) {
      const piece = new Mesh(this.wire, this.material);
      pieces.push(piece);
      this.object.add(piece);
    }
    pieces.forEach((piece, k) => {
      const along = line[k + 1]?.clone().sub(line[k]);
      const length = along?.length() ?? 0;
      piece.visible = length > 0;
      if (!piece.visible) return;
      piece.position.copy(line[k]);
      piece.quaternion.copy(new Quaternion().setFromUnitVectors(ALONG, along.divideScalar(length)));
      piece.scale.z = length;
    });
  }
}
