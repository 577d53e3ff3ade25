// Springs, dampers and cylinders: between two points as long as these are apart, along a slide, or about a pin.

import {
  BoxGeometry, CatmullRomCurve3, Group, Mesh, MeshStandardMaterial, Quaternion, TubeGeometry, Vector3,
} from "three";
import { bar, turnedOutline } from "./parts.js";
import { poseMatrix, travels } from "./travel.js";
import { frame, squareTo, vector } from "./vectors.js";

const INK = "#7b828c";
const CLEAR = 0.4; // opacity of what holds a piston or a vane
const TURNS = 8; // of a coil
const STRAIGHT = 0.12; // of the length, at both ends of a coil
const TORSION_TURNS = 3;
const PISTON = [0.2, 0.8]; // where in a cup a piston is at the least and the most length
const ALONG = new Vector3(0, 0, 1);

/** The springs, dampers and cylinders of a run, as a branch moves them. */
export class Ties {
  /** @param unit  the size of a joint */
  constructor(ties, data, branch, unit) {
    this.object = new Group();
    const travel = ties.some(({ joint }) => joint !== null) ? travels(data, branch) : [];
    this.all = ties.map((tie) => {
      const joint = data.joints[tie.joint];
      if (joint && tie.turns) return new About(tie, joint.halves, unit);
      return new Along(tie, joint ? besides(tie, joint.halves, travel[tie.joint][0], unit) : tie.places.map(vector), branch, unit);
    });
    this.all.forEach(({ group }) => this.object.add(group));
  }

  /** Puts them where the mechanism has their links now. */
  show(mechanism) {
    for (const each of this.all) {
      each.show(mechanism);
      each.group.visible &&= each.tie.links.every((link) => mechanism.links[link].visible || link === 0);
    }
  }
}

function made(geometry, opacity = 1) {
  const glass = opacity < 1 ? { transparent: true, opacity, depthWrite: false } : {};
  return new Mesh(geometry, new MeshStandardMaterial({ color: INK, roughness: 0.5, ...glass }));
}

/** From beyond the end of a rail to what slides on it: a spring about the rail, a damper beside it. */
function besides({ kind }, halves, { least, most }, unit) {
  const margin = 0.5 * (most.z - least.z) + 4 * unit;
  const ends = [Math.min(0, least.z) - margin, -1.2 * unit];
  return halves.map((half, k) => {
    const on = frame(vector(half.point), vector(half.axis), squareTo(vector(half.axis), vector(half.x)));
    return new Vector3(kind === "spring" ? 0 : 1.8 * unit, 0, ends[k]).applyMatrix4(on);
  });
}

/** Least and most distance of two places of links over the poses of a branch. */
function reach(branch, links, places) {
  const apart = Array.from({ length: branch.poseCount }, (_, index) => {
    const [from, to] = links.map((link, k) => places[k].clone().applyMatrix4(poseMatrix(branch.pose(index, link))));
    return from.distanceTo(to);
  });
  return apart.reduce(([least, most], each) => [Math.min(least, each), Math.max(most, each)], [Infinity, 0]);
}

/** Along z from one place to another: a coil that stretches, or a tube in which a piston slides. */
class Along {
  constructor(tie, places, branch, unit) {
    this.tie = tie;
    this.places = places;
    this.group = new Group();
    [this.least, this.most] = tie.stroke ?? reach(branch, tie.links, places);
    if (!(this.most > 0)) return;
    this.least = Math.max(this.least, 0.05 * this.most);
    if (tie.kind === "spring") {
      this.coil = made(coil(this.least, tie.radius ?? 0.9 * unit, 0.11 * unit));
      this.group.add(this.coil);
    } else {
      this.#tube(tie.radius ?? 0.6 * unit);
    }
  }

  /** A damper's cup is short and clear, so that its piston is seen; a cylinder's is as long as it can be. */
  #tube(radius) {
    const damper = this.tie.kind === "damper";
    this.cup = damper ? [0.2 * this.least, 0.7 * this.least] : [0, 0.92 * this.least];
    const [from, to] = this.cup;
    const wall = 0.85 * radius;
    const outline = [[0, from], [radius, from], [radius, to], [wall, to], [wall, from + 0.15 * radius], [0, from + 0.15 * radius]];
    this.rod = made(bar(0.35 * radius, 0, 1));
    this.piston = made(bar(wall, -0.2 * radius, 0.2 * radius));
    this.group.add(made(turnedOutline(outline), damper ? CLEAR : 1), this.rod, this.piston);
    if (damper) this.group.add(made(bar(0.35 * radius, 0, from + 0.1 * radius)));
  }

  show(mechanism) {
    const [from, to] = this.tie.links.map((link, k) => mechanism.now(link, this.places[k].toArray()));
    const along = to.sub(from);
    const length = along.length();
    this.group.visible = length > 0 && this.most > 0;
    if (!this.group.visible) return;
    this.group.position.copy(from);
    this.group.quaternion.copy(new Quaternion().setFromUnitVectors(ALONG, along.divideScalar(length)));
    if (this.coil) {
      this.coil.scale.z = length / this.least;
      return;
    }
    const share = this.most > this.least ? (length - this.least) / (this.most - this.least) : 0.5;
    const [start, end] = this.cup;
    this.piston.position.z = start + (end - start) * (PISTON[0] + (PISTON[1] - PISTON[0]) * Math.min(1, Math.max(0, share)));
    this.rod.position.z = this.piston.position.z;
    this.rod.scale.z = length - this.piston.position.z;
  }
}

/** About the pin of a joint: a coil that winds up, or a drum in which a vane turns. */
class About {
  constructor(tie, halves, unit) {
    this.tie = tie;
    this.unit = unit;
    this.group = new Group();
    this.frames = halves.map((half) => frame(vector(half.point), vector(half.axis), vector(half.x)));
    if (tie.kind === "spring") {
      this.coil = made(new TubeGeometry());
      this.group.add(this.coil);
    } else {
      const r = unit;
      const drum = [[0.95 * r, -0.55 * r], [1.7 * r, -0.55 * r], [1.7 * r, 0.55 * r], [0.95 * r, 0.55 * r]];
      this.vane = made(new BoxGeometry(0.7 * r, 0.16 * r, 1.0 * r).translate(1.3 * r, 0, 0));
      this.group.add(made(turnedOutline(drum), CLEAR), this.vane);
    }
  }

  show(mechanism) {
    const [first, second] = this.tie.links.map((link, k) => {
      const { position, quaternion } = mechanism.links[link];
      return poseMatrix({ t: position.toArray(), q: [quaternion.w, quaternion.x, quaternion.y, quaternion.z] }).multiply(this.frames[k]);
    });
    this.group.visible = true;
    first.decompose(this.group.position, this.group.quaternion, new Vector3());
    const x = new Vector3().setFromMatrixColumn(first.clone().invert().multiply(second), 0);
    this.angle = Math.atan2(x.y, x.x);
    if (this.vane) this.vane.rotation.z = this.angle;
    else this.#wind();
  }

  #wind() {
    if (this.wound === this.angle) return;
    this.wound = this.angle;
    this.coil.geometry.dispose();
    this.coil.geometry = torsionCoil(this.angle, this.unit);
  }
}

/** A coil along z of some length, with straight ends. */
function coil(length, radius, wire) {
  const at = (x, y, z) => new Vector3(x, y, z * length);
  const places = [at(0, 0, 0), at(0, 0, STRAIGHT)];
  const steps = 12 * TURNS;
  for (let k = 0; k <= steps; k += 1) {
    const angle = (2 * Math.PI * TURNS * k) / steps;
    places.push(at(radius * Math.cos(angle), radius * Math.sin(angle), STRAIGHT + ((1 - 2 * STRAIGHT) * k) / steps));
  }
  places.push(at(0, 0, 1 - STRAIGHT), at(0, 0, 1));
  return new TubeGeometry(new CatmullRomCurve3(places), 4 * steps, wire, 6);
}

/** A coil about z from the direction x to that at `angle`, a leg outwards at both ends. */
function torsionCoil(angle, unit) {
  const turn = 2 * Math.PI * TORSION_TURNS + angle;
  const steps = 16 * TORSION_TURNS;
  const at = (radius, share) =>
    new Vector3(radius * Math.cos(turn * share), radius * Math.sin(turn * share), (share - 0.5) * 1.5).multiplyScalar(unit);
  const places = Array.from({ length: steps + 1 }, (_, k) => at(1.25, k / steps));
  return new TubeGeometry(new CatmullRomCurve3([at(2.1, 0), ...places, at(2.1, 1)]), 4 * steps, 0.12 * unit, 6);
}
