// A joint's half: its frame as drawn, the way from it into its link, and what holds it there.

import { Vector3 } from "three";
import { bar, block, drawnOut, polygon } from "./parts.js";
import { frame, shifted, squareTo, vector } from "./vectors.js";

/** One half of a joint, which adds parts to its link's body. Lengths are in `unit`, the joint's size. */
export class Half {
  /**
   * @param stem  from the joint into the link, as drawn (unit vector, or null where the link is nothing else)
   * @param ground  whether it stands on the ground, and so on a foot
   */
  constructor(drawn, body, unit, stem, ground) {
    this.body = body;
    this.unit = unit;
    this.ground = ground;
    this.point = vector(drawn.point);
    this.axis = vector(drawn.axis).normalize();
    this.x = squareTo(this.axis, vector(drawn.x));
    this.y = this.axis.clone().cross(this.x);
    this.stem = stem ?? this.x;
    this.frame = frame(this.point, this.axis, this.x);
  }

  /** The stem made square to the axis, or null where it runs along it. */
  get across() {
    const off = this.stem.clone().addScaledVector(this.axis, -this.stem.dot(this.axis));
    return off.length() > 0.35 ? off.normalize() : null;
  }

  /** The frame at the point whose z is the axis and whose x points into the link. */
  get inward() {
    return frame(this.point, this.axis, this.across ?? this.x);
  }

  add(geometry, matrix = this.frame) {
    this.body.add(geometry, matrix);
  }

  /** A fork whose two cheeks hold what lies between +-`gap` on the axis, its back towards the link. */
  fork(gap, reach, cheek = 0.42) {
    const u = this.unit;
    const [wide, far] = [0.62 * u, reach * u];
    const outline = polygon([[far, -wide], [far, wide], [0, wide], [0, -wide]]);
    const inner = gap * u;
    const outer = (gap + cheek) * u;
    for (const [from, to] of [[inner, outer], [-outer, -inner]]) {
      this.add(drawnOut(outline, from, to), this.inward);
      this.add(bar(wide, from, to), this.inward);
    }
    this.add(block([far - cheek * u, -wide, -outer], [far, wide, outer]), this.inward);
    return far;
  }

  /** The plate by which a half on the ground stands, `distance` along its stem. */
  foot(distance, width = 1.7) {
    if (!this.ground) return;
    const u = this.unit;
    const place = this.point.clone().addScaledVector(this.stem, distance);
    const on = frame(place, this.stem, Math.abs(this.stem.dot(this.axis)) < 0.9 ? this.axis : this.x);
    this.add(block([-width * u, -width * u, 0], [width * u, width * u, 0.35 * u]), on);
  }

  /** A post from the joint to its foot. */
  post(distance, radius = 0.4) {
    if (!this.ground) return;
    const along = frame(this.point, this.stem, squareTo(this.stem, this.x));
    this.add(bar(radius * this.unit, 0, distance), along);
    this.foot(distance);
  }

  /** The frame moved along its own axes. */
  at(x, y, z) {
    return shifted(this.frame, x, y, z);
  }
}

/** Which way is into the link from each joint: towards the middle of what the link joins, or down to the ground. */
export function stemOf(points, point, ground, axis, up) {
  if (ground) return groundStem(axis, up);
  const centre = new Vector3();
  points.forEach((each) => centre.addScaledVector(each, 1 / points.length));
  const stem = centre.sub(point);
  const span = Math.max(...points.map((each) => each.distanceTo(point)), 0);
  return stem.length() > 1e-6 * span && span > 0 ? stem.normalize() : null;
}

function groundStem(axis, up) {
  const down = up.clone().negate();
  return Math.abs(down.dot(axis)) > 0.8 ? axis.clone().multiplyScalar(Math.sign(down.dot(axis))) : squareTo(axis, down);
}
