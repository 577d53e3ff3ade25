// The mechanism in one branch: a group for each link, which its pose moves.

import { Group, Quaternion, Vector3 } from "three";
import { linkColour } from "../colours.js";
import { Body } from "./body.js";
import { Half, stemOf } from "./halves.js";
import { PAIRS } from "./pairs.js";
import { bar } from "./parts.js";
import { BORE, TUBE, addShape } from "./shapes.js";
import { slideStops, travels } from "./travel.js";
import { vector } from "./vectors.js";
import { addBelt, addDisc, addScrew, addWheel } from "./wheels.js";

const JOINT_SIZE = 0.028; // of the mechanism's size
const LEAST_JOINT_SIZE = 0.008;
const SLIDING = new Set(["P", "C"]); // in a link that is drawn as a cylinder: a piston
const CLOSE = 0.22; // of the least distance between two joints of a link

/** The size of a joint where the file says nothing: fit to the mechanism, and to joints that lie close. */
export function jointUnit(data, size) {
  let least = Infinity;
  data.links.forEach((_, link) => {
    if (link === 0) return;
    const points = pointsOf(data, link);
    points.forEach((one, k) =>
      points.slice(k + 1).forEach((other) => {
        const apart = one.distanceTo(other);
        if (apart > 1e-3 * size) least = Math.min(least, apart);
      }),
    );
  });
  const wished = Math.min(JOINT_SIZE * size, CLOSE * least);
  return Math.max(LEAST_JOINT_SIZE * size, wished);
}

function pointsOf(data, link) {
  return data.joints.flatMap((joint) =>
    joint.links.flatMap((each, k) => (each === link ? [vector(joint.halves[k].point)] : [])),
  );
}

/** The bodies of all links, as drawn; rails are as long as the branch's travels. */
export class Mechanism {
  /**
   * @param unit  the size of a joint (see `jointUnit`)
   * @param ghost  the one colour of a mechanism that is drawn pale, for comparison
   */
  constructor(data, branch, unit, ghost = null) {
    this.data = data;
    this.unit = unit;
    this.object = new Group();
    const bodies = data.links.map(() => new Body());
    data.links.forEach((link, index) => addShape(bodies[index], link.shape, unit));
    data.wheels.forEach((wheel) => addWheel(bodies[wheel.link], wheel, unit));
    data.discs.forEach((disc) => addDisc(bodies[disc.link], disc, unit));
    data.belts.forEach((belt) => addBelt(bodies[belt.link], belt));
    data.screws.forEach((screw) => addScrew(bodies, screw, unit));
    const travel = travels(data, branch);
    data.joints.forEach((joint, j) => this.#addJoint(joint, bodies, travel[j]));
    this.links = bodies.map((body, index) => {
      const group = ghost ? body.ghost(ghost) : body.finish(linkColour(data.links[index], index));
      group.visible = !(ghost && index === 0) && !data.links[index].hidden; // one ground is enough
      this.object.add(group);
      return group;
    });
  }

  #addJoint(joint, bodies, travel) {
    const u = joint.radius > 0 ? Math.min(joint.radius, 4 * this.unit) : this.unit;
    const up = vector(this.data.up);
    const [first, second] = joint.halves.map((half, k) => {
      const link = joint.links[k];
      const [point, axis] = [vector(half.point), vector(half.axis).normalize()];
      const others = [...pointsOf(this.data, link), ...this.data.links[link].shape.points.map(vector)];
      const stem = stemOf(others, point, link === 0, axis, up);
      return new Half(half, bodies[link], u, stem, link === 0);
    });
    const tube = joint.links.map((link) => this.data.links[link].shape).find(({ kind }) => kind === "cylinder");
    if (tube && SLIDING.has(joint.type)) {
      const bore = BORE * (tube.radius ?? TUBE * this.unit);
      const rod = this.data.links[joint.links[1]].shape === tube ? first : second;
      rod.add(bar(bore, -0.5 * bore, 0.5 * bore));
      return;
    }
    const stops = slideStops(joint, this.data.size);
    PAIRS.get(joint.type)?.({ joint, stops, first, second, u, travel, flat: this.data.planar });
  }

  /** Puts the links where a branch has them; `place` may lie between two poses (see `between`). */
  show(branch, index, next = index, share = 0) {
    this.links.forEach((group, link) => {
      const { t, q } = branch.pose(index, link);
      group.position.set(...t);
      group.quaternion.set(q[1], q[2], q[3], q[0]);
      if (share > 0) blend(group, this.#middle(link), branch.pose(next, link), share);
    });
  }

  /** The drawn place about which a link turns least on the screen. */
  #middle(link) {
    this.middles ??= this.data.links.map((each, k) => {
      const points = [...pointsOf(this.data, k), ...each.shape.points.map(vector)];
      const middle = new Vector3();
      points.forEach((point) => middle.addScaledVector(point, 1 / points.length));
      return middle;
    });
    return this.middles[link];
  }

  /** Where a place drawn on a link is now. */
  now(link, place) {
    const group = this.links[link];
    return vector(place).applyQuaternion(group.quaternion).add(group.position);
  }
}

/** Turns about the link's middle, which goes straight on, so that long links keep their joints together. */
function blend(group, middle, pose, share) {
  const from = middle.clone().applyQuaternion(group.quaternion).add(group.position);
  const turn = new Quaternion(pose.q[1], pose.q[2], pose.q[3], pose.q[0]);
  const to = middle.clone().applyQuaternion(turn).add(new Vector3(...pose.t));
  group.quaternion.slerp(turn, share);
  const reached = middle.clone().applyQuaternion(group.quaternion);
  group.position.copy(from.lerp(to, share).sub(reached));
}
