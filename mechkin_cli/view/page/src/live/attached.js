// What is drawn on a joint's axis goes with the joint where dimensions change: wheels, cams, spindles, pulleys, belts.

import { cableLine } from "../scene/cables.js";
import { vector } from "../scene/vectors.js";

const CLOSE = 1e-6; // of the mechanism's size
const MESH = 0.02; // of the sum of two radii: so near to it their centres are apart where wheels mesh

/** Finds once what hangs on which joint, and then moves it. */
export class Attached {
  constructor(data) {
    this.data = data;
    const on = (link, place, axis) => this.#jointAt(link, place, axis);
    this.wheels = data.wheels.map(({ link, centre, axis }) => on(link, centre, axis));
    this.discs = data.discs.map(({ link, centre, axis }) => on(link, centre, axis));
    this.screws = data.screws.map(({ link, centre, axis, nut }) => [on(link, centre, axis), on(nut.link, nut.centre, nut.axis)]);
    this.cables = data.cables.map(({ links, places, axes }) => places.map((place, k) => on(links[k], place, axes[k])));
    this.points = data.cables.map(({ links, places }) => places.map((place, k) => this.#pointAt(links[k], place)));
    this.belts = data.belts.map((belt) => this.#pulleysOf(belt));
    this.meshes = data.wheels.map((wheel) => this.#meshOf(wheel));
  }

  /** The parts of the data that hang on the joints and points of `drawn`. */
  moved({ joints = this.data.joints, points = this.data.points, wheels = this.data.wheels, cables = this.data.cables }) {
    const { data } = this;
    const shift = (place, at) => {
      if (!at) return place;
      const before = at.point === undefined ? data.joints[at.joint].halves[at.half].point : data.points[at.point].place;
      const now = at.point === undefined ? joints[at.joint].halves[at.half].point : points[at.point].place;
      return place.map((each, k) => each + now[k] - before[k]);
    };
    const centres = data.wheels.map(({ centre }, k) => shift(centre, this.wheels[k]));
    const radii = wheels.map(({ radius }, k) => (radius === data.wheels[k].radius ? radius * this.#growth(k, centres) : radius));
    return {
      wheels: data.wheels.map((wheel, k) => ({ ...wheel, centre: centres[k], radius: radii[k] })),
      belts: data.belts.map((belt, k) => this.#laid(belt, this.belts[k], radii, shift)),
      discs: data.discs.map((disc, k) => ({ ...disc, centre: shift(disc.centre, this.discs[k]) })),
      screws: data.screws.map((screw, k) => ({
        ...screw, centre: shift(screw.centre, this.screws[k][0]), nut: { ...screw.nut, centre: shift(screw.nut.centre, this.screws[k][1]) },
      })),
      cables: cables.map((cable, k) => ({
        ...cable, places: cable.places.map((place, n) => shift(place, this.points[k][n] ?? this.cables[k][n])),
      })),
    };
  }

  /** The pulleys that a belt runs over, in its order: {wheel, at, centre, turn}, the half of a joint on its carrier, the centre
   * there, and which way it runs about its axis; null where it is not seen to run over any. */
  #pulleysOf({ link, line, axis }) {
    const { joints, wheels, size } = this.data;
    const pulleys = wheels.flatMap((wheel, k) => {
      const joint = this.wheels[k]?.joint ?? -1;
      const half = joints[joint]?.links.indexOf(link) ?? -1;
      return half < 0 ? [] : [{ wheel: k, at: { joint, half } }];
    });
    if (pulleys.length < 2) return null;
    const off = (place, { wheel, at }) => Math.abs(offLine(place, joints[at.joint].halves[at.half].point, axis) - wheels[wheel].radius);
    const over = line.map((place) => pulleys.reduce((best, each) => (off(place, each) < off(place, best) - CLOSE * size ? each : best)));
    const starts = over.flatMap((each, k) => (each === over.at(k - 1) ? [] : [k]));
    const found = starts.map((start) => {
      const { wheel, at } = over[start];
      const next = (start + 1) % line.length;
      const { point } = joints[at.joint].halves[at.half];
      const along = point.reduce((sum, each, k) => sum + (line[start][k] - each) * axis[k], 0);
      const centre = point.map((each, k) => each + along * axis[k]);
      const [from, to] = [start, next].map((k) => vector(line[k]).sub(vector(centre)));
      return over[next] === over[start] ? { wheel, at, centre, turn: Math.sign(from.cross(to).dot(vector(axis))) } : null;
    });
    return found.length < 2 || found.includes(null) ? null : found;
  }

  /** A belt with its pulleys where and as large as they are now. */
  #laid(belt, pulleys, radii, shift) {
    if (pulleys === null) return belt;
    const centres = pulleys.map(({ centre, at }) => shift(centre, at));
    const same = pulleys.every(({ wheel, centre }, k) => distance(centre, centres[k]) === 0 && radii[wheel] === this.data.wheels[wheel].radius);
    if (same) return belt;
    // once round, and on to the second pulley again
    const round = [...pulleys.keys(), 0, 1];
    const line = cableLine(
      round.map((k) => vector(centres[k])), round.map((k) => -pulleys[k].turn * radii[pulleys[k].wheel]),
      round.map(() => vector(belt.axis)), round.map(() => 0),
    );
    return { ...belt, line: line.slice(1, -1).map((place) => place.toArray()) };
  }

  /** Wheels of a fixed ratio grow with the distance of their centres. */
  #growth(k, centres) {
    const other = this.meshes[k];
    if (other < 0) return 1;
    const { wheels } = this.data;
    return distance(centres[k], centres[other]) / distance(wheels[k].centre, wheels[other].centre);
  }

  /** The joint half of a link on whose axis a place lies, or null. */
  #jointAt(link, place, axis) {
    const { joints, size } = this.data;
    for (const [joint, { links, halves }] of joints.entries()) {
      for (const half of [0, 1]) {
        if (links[half] === link && offLine(place, halves[half].point, axis) <= CLOSE * size) return { joint, half };
      }
    }
    return null;
  }

  #pointAt(link, place) {
    const point = this.data.points.findIndex((each) => each.link === link && distance(each.place, place) <= CLOSE * this.data.size);
    return point < 0 ? null : { point };
  }

  /** The wheel that one meshes with as it is drawn, or -1. */
  #meshOf(wheel) {
    return this.data.wheels.findIndex((other) => {
      if (other.link === wheel.link || other.reach || wheel.reach || wheel.apex || other.apex) return false;
      const apart = distance(wheel.centre, other.centre);
      const wished = wheel.inner || other.inner ? Math.abs(wheel.radius - other.radius) : wheel.radius + other.radius;
      return apart > 0 && Math.abs(apart - wished) <= MESH * (wheel.radius + other.radius);
    });
  }
}

const distance = (a, b) => Math.hypot(...a.map((each, k) => each - b[k]));

/** How far a place is from the line through a point along a unit direction. */
function offLine(place, point, axis) {
  const off = place.map((each, k) => each - point[k]);
  const along = off.reduce((sum, each, k) => sum + each * axis[k], 0);
  return Math.hypot(...off.map((each, k) => each - along * axis[k]));
}
