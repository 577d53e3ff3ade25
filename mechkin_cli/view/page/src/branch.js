// One branch of a run: its rows, and the poses of the links at those rows that have one.

import { DOUBTS } from "./colours.js";
import { numbers } from "./data.js";

const PER_LINK = 7; // tx ty tz q0 q1 q2 q3

/** A branch with its arrays decoded. */
export class Branch {
  constructor(packed, linkCount) {
    this.packed = packed;
    this.name = packed.name;
    this.own = packed.own;
    this.rows = packed.rows;
    this.linkCount = linkCount;
    this.x = numbers(packed.x);
    this.poseRows = numbers(packed.poses.rows);
    this.values = numbers(packed.poses.values);
    this.codes = numbers(packed.status.codes);
    this.words = packed.status.words;
    this.doubts = packed.status.doubts;
    this.marks = packed.marks ?? [];
    this.columns = packed.columns ?? [];
    this.arrows = packed.arrows ?? [];
    this.direction = direction(this.x);
  }

  get poseCount() {
    return this.poseRows.length;
  }

  /** The colour of a verdict by its code. */
  colour(code) {
    return DOUBTS[this.doubts[code]] ?? DOUBTS.at(-1);
  }

  /** The verdict of a row, in words. */
  verdict(row) {
    return this.words[this.codes[row]] ?? "";
  }

  /** Stretches of rows of one verdict: [{code, from, to}], both ends within. */
  stretches() {
    const found = [];
    this.codes.forEach((code, row) => {
      if (found.at(-1)?.code === code) found.at(-1).to = row;
      else found.push({ code, from: row, to: row });
    });
    return found;
  }

  /** The index of the pose nearest to a row, or -1 where no row has one. */
  poseNear(row) {
    const rows = this.poseRows;
    if (rows.length === 0) return -1;
    let low = 0;
    let high = rows.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (rows[middle] < row) low = middle + 1;
      else high = middle;
    }
    return low > 0 && row - rows[low - 1] <= rows[low] - row ? low - 1 : low;
  }

  /** The translation and quaternion, scalar first, of a link at a pose. */
  pose(index, link) {
    const start = (index * this.linkCount + link) * PER_LINK;
    const v = this.values.subarray(start, start + PER_LINK);
    return { t: [v[0], v[1], v[2]], q: [v[3], v[4], v[5], v[6]] };
  }

  /** The row whose x is nearest. */
  rowAt(x) {
    let best = 0;
    let least = Infinity;
    for (let row = 0; row < this.rows; row += 1) {
      const off = Math.abs(this.x[row] - x);
      if (off < least) [best, least] = [row, off];
    }
    return best;
  }

  /** Whether the first and the last pose are the same place, so that playing on looks like a cycle. */
  closes() {
    const last = this.poseCount - 1;
    if (last < 2) return false;
    let [off, size] = [0, 0];
    for (let link = 0; link < this.linkCount; link += 1) {
      const [a, b] = [this.pose(0, link), this.pose(last, link)];
      a.t.forEach((value, k) => {
        off = Math.max(off, Math.abs(value - b.t[k]));
        size = Math.max(size, Math.abs(value));
      });
      const cosine = Math.abs(a.q.reduce((sum, value, k) => sum + value * b.q[k], 0));
      if (cosine < 0.9995) return false;
    }
    return off <= 0.02 * size;
  }
}

/** 1 where the numbers grow from row to row, -1 where they fall, 0 where they do neither. */
function direction(x) {
  let [up, down] = [true, true];
  for (let row = 1; row < x.length; row += 1) {
    if (!(x[row] > x[row - 1])) up = false;
    if (!(x[row] < x[row - 1])) down = false;
  }
  if (up) return 1;
  return down ? -1 : 0;
}
