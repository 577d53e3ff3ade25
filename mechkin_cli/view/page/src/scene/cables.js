// Cables over points, pulleys and drums: lines that every pose lays anew, and the pulleys they run over.

import { Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { bar } from "./parts.js";
import { vector } from "./vectors.js";

const INK = "#4b525c";
const SIDES = 48; // of a full turn
const ALONG = new Vector3(0, 0, 1);
const [WIRE, PULLEY] = [0.14, 0.5]; // radius of a cable and half the width of a pulley, in joint sizes

/** The line of a cable past centres, `beside` to the left of each in the plane z, as `cable_line` of the small pictures. */
export function cableLine(centres, beside) {
  const line = beside[0] === 0 ? [centres[0]] : [];
  centres.slice(1).forEach((other, k) => {
    const [one, near, far] = [centres[k], beside[k], beside[k + 1]];
    if (near === 0 && far === 0) {
      line.push(other);
      return;
    }
    const apart = other.clone().sub(one);
    const square = apart.lengthSq();
    const by = near - far;
    const length = Math.sqrt(Math.max(square - by * by, 0));
    const along = apart.clone().multiplyScalar(length).sub(leftOf(apart).multiplyScalar(by)).divideScalar(square);
    const start = one.clone().addScaledVector(leftOf(along), near);
    if (near !== 0) line.push(...(k > 0 ? wound(one, line.at(-1), start, near) : [start]));
    line.push(other.clone().addScaledVector(leftOf(along), far));
  });
  return line;
}

const leftOf = ({ x, y }) => new Vector3(-y, x, 0);

/** Places on a pulley: clockwise where it is passed on its left. */
function wound(centre, first, last, beside) {
  const sense = beside > 0 ? -1 : 1;
  const angle = (place) => Math.atan2(place.y - centre.y, place.x - centre.x);
  const start = angle(first);
  const turn = (((sense * (angle(last) - start)) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI);
  const steps = Math.max(1, Math.ceil((turn * SIDES) / (2 * Math.PI)));
  return Array.from({ length: steps }, (_, k) => {
    const now = start + (sense * turn * (k + 1)) / steps;
    return new Vector3(Math.cos(now), Math.sin(now), 0).multiplyScalar(Math.abs(beside)).add(centre);
  });
}

/** The cables of a mechanism. */
export class Cables {
  /** @param unit  the size of a joint */
  constructor(cables, unit) {
    this.cables = cables;
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
    this.cables.forEach(({ links, places, beside }, n) => {
      const centres = places.map((place, k) => mechanism.now(links[k], place));
      this.wheels[n].forEach((wheel, k) => wheel?.position.copy(centres[k]));
      this.#lay(this.pieces[n], cableLine(centres, beside));
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
