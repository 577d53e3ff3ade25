// Vectors and frames as drawn: small helpers over three's.

import { Matrix4, Vector3 } from "three";

export const vector = (numbers) => new Vector3(numbers[0], numbers[1], numbers[2]);

/** A unit vector square to `axis`, as near to `wish` as can be. */
export function squareTo(axis, wish) {
  const along = axis.clone().normalize();
  for (const each of [wish, new Vector3(1, 0, 0), new Vector3(0, 1, 0)]) {
    if (!each) continue;
    const made = each.clone().addScaledVector(along, -each.dot(along));
    if (made.lengthSq() > 0.02 * each.lengthSq() && made.lengthSq() > 0) return made.normalize();
  }
  throw new Error("an axis has no direction");
}

/** The frame at `point` whose z is `axis` and whose x is `wish` made square to it. */
export function frame(point, axis, wish) {
  const z = axis.clone().normalize();
  const x = squareTo(z, wish);
  return new Matrix4().makeBasis(x, z.clone().cross(x), z).setPosition(point);
}

/** A shift in a frame's own directions, after the frame. */
export const shifted = (matrix, x, y, z) => matrix.clone().multiply(new Matrix4().makeTranslation(x, y, z));
