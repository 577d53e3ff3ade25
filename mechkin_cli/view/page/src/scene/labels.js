// Names beside what they name: text over the canvas, moved apart where two would lie on each other.

import { element } from "../dom.js";

const OFF = 12; // pixels from the place to its name
const WAYS = [[1, -1], [1, 1], [-1, -1], [-1, 1], [0, -1.6], [0, 1.6], [2.2, 0], [-2.2, 0]];

/** Names on the stage. */
export class Labels {
  constructor(host) {
    this.host = host;
    this.made = new Map();
  }

  /**
   * @param wanted  [{key, text, places: [Vector3], kind}]: at the first place that is seen; the rest goes away
   * @param covered  boxes [left, top, right, bottom] where no name may be
   * @returns  keys of those that are seen and have no free place
   */
  show(wanted, camera, width, height, covered = []) {
    const kept = new Set();
    const taken = [...covered];
    const left = [];
    for (const { key, text, places, kind } of wanted) {
      const seen = places.map((place) => place.clone().project(camera)).find(isSeen);
      if (!seen) continue;
      const label = this.#label(key, text, kind);
      const at = [((1 + seen.x) * width) / 2, ((1 - seen.y) * height) / 2];
      const box = freePlace(at, label.size, taken, width, height);
      if (!box) {
        left.push(key);
        continue;
      }
      taken.push(box);
      kept.add(key);
      label.node.style.transform = `translate(${Math.round(box[0])}px, ${Math.round(box[1])}px)`;
      label.node.hidden = false;
      label.box = box;
    }
    for (const [key, label] of this.made) if (!kept.has(key)) label.node.hidden = true;
    return left;
  }

  /** Writes the names that are shown into a picture of the stage, `ratio` of its pixels to one of the page. */
  write(brush, ratio, ground = "#ffffff") {
    brush.textBaseline = "middle";
    for (const { node, text, box } of this.made.values()) {
      if (node.hidden) continue;
      const { color, fontWeight, fontSize, fontFamily } = getComputedStyle(node);
      brush.font = `${fontWeight} ${parseFloat(fontSize) * ratio}px ${fontFamily}`;
      brush.fillStyle = color;
      brush.strokeStyle = ground;
      brush.lineWidth = 3 * ratio;
      brush.lineJoin = "round";
      const [left, top, right, bottom] = box.map((each) => each * ratio);
      const width = Math.min(brush.measureText(text).width, right - left);
      // on paper a name has no ground of its own, but an edge
      const at = [(left + right - width) / 2, (top + bottom) / 2, right - left];
      brush.strokeText(text, ...at);
      brush.fillText(text, ...at);
    }
  }

  #label(key, text, kind) {
    let label = this.made.get(key);
    if (!label) {
      const node = element(`span.name.${kind}`);
      this.host.append(node);
      label = { node, text: null, size: [0, 0] };
      this.made.set(key, label);
    }
    if (label.text !== text) {
      label.node.hidden = false;
      label.node.textContent = text;
      label.text = text;
      label.size = [label.node.offsetWidth, label.node.offsetHeight];
    }
    return label;
  }

  clear() {
    for (const label of this.made.values()) label.node.remove();
    this.made.clear();
  }
}

const isSeen = ({ x, y, z }) => z < 1 && Math.abs(x) < 0.99 && Math.abs(y) < 0.99;

/** The first box [left, top, right, bottom] about a place that is free; null where none is. */
function freePlace([x, y], [width, height], taken, right, bottom) {
  for (const [dx, dy] of WAYS) {
    const left = x + dx * OFF - (dx < 0 ? width : dx === 0 ? width / 2 : 0);
    const top = y + dy * OFF - height / 2;
    const box = [left, top, left + width, top + height];
    const inside = left >= 0 && top >= 0 && box[2] <= right && box[3] <= bottom;
    if (inside && !taken.some((other) => overlap(box, other))) return box;
  }
  return null;
}

const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
