// Forces and moments to scale: an arrow from where a force acts; a moment has two heads, by the right-hand rule.

import {
  ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3,
} from "three";
import { ARROWS } from "../colours.js";
import { numbers } from "../data.js";

const LONGEST = 0.22; // of the mechanism's size, for the usual largest value
const CUT = 0.6; // of the mechanism's size; what is longer is cut and pale
const HEAD = 1.8; // length of a head, in joint sizes
const USUAL = 0.97; // share of values that the scale is made for: near dead centres forces have no bound
const UP = new Vector3(0, 1, 0);

/** All arrows of a branch. */
export class Arrows {
  constructor(data, branch, unit, size) {
    this.size = size;
    this.longest = data.view?.arrow_length ?? LONGEST * size;
    this.zoom = 1;
    this.unit = unit;
    this.object = new Group();
    this.all = branch.arrows.map((arrow) => {
      const made = shaped(arrow.kind, unit);
      this.object.add(made.group);
      return { arrow, ...made, shown: false };
    });
    this.headLength = HEAD * unit;
    this.turnTo(branch);
  }

  /** Takes the values of another branch; false where it has other arrows. */
  turnTo({ arrows, poseCount }) {
    const same = arrows.length === this.all.length && arrows.every(({ name, kind }, k) => name === this.all[k].arrow.name && kind === this.all[k].arrow.kind);
    if (!same) return false;
    this.usual = {};
    for (const kind of ["force", "moment"]) this.usual[kind] = usualLargest(arrows, poseCount, kind);
    this.all.forEach((each, k) => Object.assign(each, { arrow: arrows[k], values: numbers(arrows[k].values) }));
    return true;
  }

  /** The length of an arrow of one unit. */
  scale(kind) {
    return this.usual[kind] > 0 ? (this.zoom * this.longest) / this.usual[kind] : 0;
  }

  /** Puts the arrows at a pose's values. */
  show(mechanism, index) {
    for (const each of this.all) {
      const { arrow, group, values } = each;
      const value = new Vector3(...values.subarray(3 * index, 3 * index + 3));
      const magnitude = value.length();
      const wished = magnitude * this.scale(arrow.kind);
      each.magnitude = magnitude;
      group.visible = each.shown && Number.isFinite(wished) && wished > 1e-4 * this.size;
      if (!group.visible) continue;
      const length = Math.min(wished, CUT * this.size);
      each.cut = wished > length;
      each.material.opacity = each.cut ? 0.4 : 1;
      group.position.copy(mechanism.now(arrow.link, arrow.place));
      group.quaternion.copy(new Quaternion().setFromUnitVectors(UP, value.normalize()));
      const head = Math.min(this.headLength, 0.45 * length);
      each.shaft.scale.set(1, Math.max(length - head, 1e-6), 1);
      each.heads.forEach((cone, k) => {
        cone.scale.setScalar(head / this.headLength);
        cone.position.y = length - head * (1 + 0.75 * k);
      });
      each.tip = value.clone().multiplyScalar(length).add(group.position);
    }
  }
}

/** A shaft of unit length along y with one head, or two. */
function shaped(kind, unit) {
  const material = new MeshStandardMaterial({ color: ARROWS[kind], roughness: 0.6, transparent: true });
  const group = new Group();
  const shaft = new Mesh(new CylinderGeometry(0.15 * unit, 0.15 * unit, 1, 12).translate(0, 0.5, 0), material);
  const length = HEAD * unit;
  const heads = (kind === "moment" ? [0, 1] : [0]).map(
    () => new Mesh(new ConeGeometry(0.48 * unit, length, 18).translate(0, length / 2, 0), material),
  );
  group.add(shaft, ...heads);
  return { group, shaft, heads, material };
}

/** The magnitude that all but a few of the values stay below. */
function usualLargest(all, count, kind) {
  const largest = [];
  const arrows = all.filter((each) => each.kind === kind).map((each) => numbers(each.values));
  for (let index = 0; index < count; index += 1) {
    let most = 0;
    for (const values of arrows) {
      const length = Math.hypot(values[3 * index], values[3 * index + 1], values[3 * index + 2]);
      if (length > most) most = length;
    }
    largest.push(most);
  }
  largest.sort((a, b) => a - b);
  return largest[Math.floor(USUAL * (largest.length - 1))] ?? 0;
}
