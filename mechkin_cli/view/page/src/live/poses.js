// Poses of links from what the kernel's run writes of each: a place on it, and the ground axes as drawn on it.

const AS_DRAWN = [1, 0, 0, 0]; // a quaternion

/** Poses of the rows from `first` to before `last`, as the page's data have them. */
export function posesOf(run, first, last) {
  const { live, data } = run;
  const links = data.links.length;
  const count = last - first;
  const values = new Float32Array(count * links * 7);
  const atHome = [...live.home, ...AS_DRAWN]; // as in the file's rows: what is drawn is told about the mechanism's datum
  const moving = new Set(live.poses.map(({ link }) => link));
  for (let link = 0; link < links; link += 1) {
    if (!moving.has(link)) for (let row = 0; row < count; row += 1) values.set(atHome, (row * links + link) * 7);
  }
  for (const pose of live.poses) posesOfLink(run, pose, first, count, links, values);
  return { rows: Int32Array.from({ length: count }, (_, row) => first + row), values };
}

function posesOfLink(run, { link, axes, place, drawn }, first, count, links, values) {
  const [multiplier, divisor] = run.live.length;
  const unit = divisor / multiplier;
  const [hx, hy, hz] = drawn.map((at) => run.numbers[at]);
  const m = axes.flatMap((slot) => [0, 1, 2].map((k) => run.slot(slot + k))); // the columns of the rotation
  const p = [0, 1, 2].map((k) => run.slot(place + k));
  let [b0, b1, b2, b3] = [0, 0, 0, 0]; // the quaternion of the row before
  for (let row = 0; row < count; row += 1) {
    const at = first + row;
    const to = (row * links + link) * 7;
    for (let axis = 0; axis < 3; axis += 1) {
      values[to + axis] = (p[axis][at] - (m[axis][at] * hx + m[3 + axis][at] * hy + m[6 + axis][at] * hz)) * unit;
    }
    const [m00, m10, m20, m01, m11, m21, m02, m12, m22] = [m[0][at], m[1][at], m[2][at], m[3][at], m[4][at], m[5][at], m[6][at], m[7][at], m[8][at]];
    // the row of the quaternion's square whose diagonal is largest
    let [q0, q1, q2, q3] = [1 + m00 + m11 + m22, m21 - m12, m02 - m20, m10 - m01];
    let best = q0;
    if (1 + m00 - m11 - m22 > best) [best, q0, q1, q2, q3] = [1 + m00 - m11 - m22, m21 - m12, 1 + m00 - m11 - m22, m10 + m01, m20 + m02];
    if (1 - m00 + m11 - m22 > best) [best, q0, q1, q2, q3] = [1 - m00 + m11 - m22, m02 - m20, m10 + m01, 1 - m00 + m11 - m22, m21 + m12];
    if (1 - m00 - m11 + m22 > best) [q0, q1, q2, q3] = [m10 - m01, m20 + m02, m21 + m12, 1 - m00 - m11 + m22];
    let size = Math.sqrt(q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3);
    if (row === 0 ? q0 < 0 : q0 * b0 + q1 * b1 + q2 * b2 + q3 * b3 < 0) size = -size;
    [b0, b1, b2, b3] = [q0 / size, q1 / size, q2 / size, q3 / size];
    values[to + 3] = b0;
    values[to + 4] = b1;
    values[to + 5] = b2;
    values[to + 6] = b3;
  }
}
