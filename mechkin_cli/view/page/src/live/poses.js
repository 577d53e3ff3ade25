// Poses of links from what the kernel's run writes of each: a place on it, and the ground axes as drawn on it.

/** Poses of the rows from `first` to before `last`, as the page's data have them. */
export function posesOf(run, first, last) {
  const { live, data, numbers } = run;
  const own = data.runs[0].branches[0].poses;
  const links = data.links.length;
  const count = last - first;
  const values = new Float32Array(count * links * 7);
  for (let row = 0; row < count; row += 1) for (let link = 0; link < links; link += 1) values[(row * links + link) * 7 + 3] = 1;
  const { length: [multiplier, divisor] } = live;
  const datum = datumOf(own, data, live);
  for (let row = 0; row < count; row += 1) for (let link = 0; link < links; link += 1) values.set(datum, (row * links + link) * 7);
  for (const { link, axes, place, drawn } of live.poses) {
    const home = drawn.map((at) => numbers[at]);
    const columns = axes.map((slot) => [0, 1, 2].map((k) => run.slot(slot + k)));
    const places = [0, 1, 2].map((k) => run.slot(place + k));
    let before = null;
    for (let row = 0; row < count; row += 1) {
      const here = first + row;
      const rotation = columns.map((column) => column.map((values3) => values3[here]));
      const to = (row * links + link) * 7;
      for (let axis = 0; axis < 3; axis += 1) {
        const carried = rotation[0][axis] * home[0] + rotation[1][axis] * home[1] + rotation[2][axis] * home[2];
        values[to + axis] = ((places[axis][here] - carried) * divisor) / multiplier;
      }
      const turn = quaternion(rotation);
      const back = before && turn[0] * before[0] + turn[1] * before[1] + turn[2] * before[2] + turn[3] * before[3] < 0;
      before = back ? turn.map((x) => -x) : turn;
      values.set(before, to + 3);
    }
  }
  return { rows: Int32Array.from({ length: count }, (_, row) => first + row), values };
}

/** The shift of what stands still. */
function datumOf() {
  return [0, 0, 0];
}

/** The unit quaternion, scalar first and not negative, of a rotation's columns. */
function quaternion([[m00, m10, m20], [m01, m11, m21], [m02, m12, m22]]) {
  const [q01, q02, q03] = [m21 - m12, m02 - m20, m10 - m01];
  const [q12, q13, q23] = [m10 + m01, m20 + m02, m21 + m12];
  const outer = [
    [1 + m00 + m11 + m22, q01, q02, q03],
    [q01, 1 + m00 - m11 - m22, q12, q13],
    [q02, q12, 1 - m00 + m11 - m22, q23],
    [q03, q13, q23, 1 - m00 - m11 + m22],
  ];
  let best = 0;
  for (let k = 1; k < 4; k += 1) if (outer[k][k] > outer[best][best]) best = k;
  const row = outer[best];
  const size = Math.hypot(...row) * (row[0] < 0 ? -1 : 1);
  return row.map((x) => x / size);
}
