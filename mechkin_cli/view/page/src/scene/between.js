// Between two computed poses a picture may pass smoothly where they are near: only while it plays.

const MOST_TURN = Math.cos((15 * Math.PI) / 180 / 2);

/** {index, next, share} of the poses to draw at a place; `share` is 0 where a computed pose is drawn. */
export function posesAt(branch, place) {
  const index = branch.poseNear(Math.round(place));
  if (Number.isInteger(place) || index < 0) return { index, next: index, share: 0 };
  const rows = branch.poseRows;
  const low = rows[index] <= place ? index : index - 1;
  const high = low + 1;
  if (low < 0 || high >= rows.length || !joined(branch, low)) return { index, next: index, share: 0 };
  return { index: low, next: high, share: (place - rows[low]) / (rows[high] - rows[low]) };
}

/** Whether nothing lies between a pose and the next: no row without solution, no large turn. */
function joined(branch, low) {
  const rows = branch.poseRows;
  const stride = Math.max(1, Math.ceil(branch.rows / rows.length)) + 1;
  if (rows[low + 1] - rows[low] > stride) return false;
  for (let link = 0; link < branch.linkCount; link += 1) {
    const [a, b] = [branch.pose(low, link).q, branch.pose(low + 1, link).q];
    if (Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]) < MOST_TURN) return false;
  }
  return true;
}
