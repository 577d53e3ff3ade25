// Springs and dampers between two points: a coil, and a rod in a cylinder, as long as their points are apart.

import {
  CatmullRomCurve3, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, TubeGeometry, Vector3,
} from "three";

const INK = "#7b828c";
const TURNS = 8; // of a coil
const STRAIGHT = 0.12; // of the length, at both ends of a coil
const UP = new Vector3(0, 1, 0);

/** The springs and dampers of a run. */
export class Ties {
  /** @param unit  the size of a joint */
  constructor(ties, unit) {
    this.unit = unit;
    this.object = new Group();
    this.all = ties.map((tie) => {
      const group = new Group();
      this.object.add(group);
      return { tie, group };
    });
  }

  /** Shapes of the length at which a tie is first shown: later they are stretched, and nearly as thick. */
  #make(each, length) {
    const material = new MeshStandardMaterial({ color: INK, roughness: 0.5 });
    const shapes = each.tie.kind === "spring" ? coil(length, this.unit) : cylinder(length, this.unit);
    each.group.add(...shapes.map((shape) => new Mesh(shape, material)));
    each.length = length;
  }

  /** Puts them between their points as the mechanism has them now. */
  show(mechanism) {
    for (const each of this.all) {
      const { tie, group } = each;
      const [from, to] = tie.links.map((link, k) => mechanism.now(link, tie.places[k]));
      const along = to.sub(from);
      const length = along.length();
      group.visible = length > 0 && tie.links.every((link) => mechanism.links[link].visible || link === 0);
      if (!group.visible) continue;
      if (!each.length) this.#make(each, length);
      group.position.copy(from);
      group.quaternion.copy(new Quaternion().setFromUnitVectors(UP, along.divideScalar(length)));
      group.scale.set(1, length / each.length, 1);
    }
  }
}

/** A coil along y. */
function coil(length, unit) {
  const at = (x, y, z) => new Vector3(x, y * length, z);
  const places = [at(0, 0, 0), at(0, STRAIGHT, 0)];
  const steps = 12 * TURNS;
  for (let k = 0; k <= steps; k += 1) {
    const angle = (2 * Math.PI * TURNS * k) / steps;
    const y = STRAIGHT + ((1 - 2 * STRAIGHT) * k) / steps;
    places.push(at(0.7 * unit * Math.cos(angle), y, 0.7 * unit * Math.sin(angle)));
  }
  places.push(at(0, 1 - STRAIGHT, 0), at(0, 1, 0));
  return [new TubeGeometry(new CatmullRomCurve3(places), 4 * steps, 0.1 * unit, 6)];
}

/** A rod along y in a cylinder about its first half. */
function cylinder(length, unit) {
  return [
    new CylinderGeometry(0.15 * unit, 0.15 * unit, length, 12).translate(0, 0.5 * length, 0),
    new CylinderGeometry(0.5 * unit, 0.5 * unit, 0.4 * length, 18).translate(0, 0.35 * length, 0),
  ];
}
