// How far the halves of each joint move against each other, from the poses: so long are rails and plates.

import { Matrix4, Quaternion, Vector3 } from "three";
import { frame, vector } from "./vectors.js";

const MOST_POSES = 200; // between them a rail's end is not missed by much

/**
 * For each joint and each of its halves, the box [least, most] (Vector3) of the other half's point in this half's frame.
 * @returns {Array<[Box, Box]>}
 */
export function travels(data, branch) {
  const frames = data.joints.map((joint) =>
    joint.halves.map((half) => frame(vector(half.point), vector(half.axis), vector(half.x))),
  );
  const boxes = data.joints.map(() => [emptyBox(), emptyBox()]);
  const stride = Math.max(1, Math.ceil(branch.poseCount / MOST_POSES));
  for (let index = 0; index < branch.poseCount; index += stride) {
    const poses = data.links.map((_, link) => poseMatrix(branch.pose(index, link)));
    data.joints.forEach((joint, j) => {
      const placed = joint.links.map((link, k) => poses[link].clone().multiply(frames[j][k]));
      placed.forEach((own, k) => {
        const other = new Vector3().setFromMatrixPosition(placed[1 - k]);
        grow(boxes[j][k], other.applyMatrix4(own.clone().invert()));
      });
    });
  }
  return boxes.map((pair) => pair.map((box) => (box.least.x <= box.most.x ? box : zeroBox())));
}

/** The matrix x = R(q) x0 + t of a pose. */
export function poseMatrix({ t, q }) {
  return new Matrix4().compose(
    new Vector3(...t), new Quaternion(q[1], q[2], q[3], q[0]), new Vector3(1, 1, 1),
  );
}

const STOPS = 0.5; // farther from where a joint slides, in parts of the mechanism's size, no stop is drawn

/** Where `limits:` stop a joint's slide, null on a side that is not drawn. */
export function slideStops({ stops, travel }, size) {
  const [least, most] = travel ?? [0, 0];
  const near = (end) => (end > least - STOPS * size && end < most + STOPS * size ? end : null);
  return (stops.slide ?? [null, null]).map((end) => (end === null ? null : near(end)));
}

const emptyBox = () => ({
  least: new Vector3(Infinity, Infinity, Infinity), most: new Vector3(-Infinity, -Infinity, -Infinity),
});
const zeroBox = () => ({ least: new Vector3(), most: new Vector3() });

function grow(box, point) {
  box.least.min(point);
  box.most.max(point);
}
