// Dragging what is driven: the mechanism goes to the place on its branch where what was taken is nearest to the pointer.

import { Raycaster, Vector2, Vector3 } from "three";
import { told } from "../numbers.js";

const NEAR = 0.08; // of the rows to either side are looked at first: what is dragged does not jump to another turn
const CLEARLY = 24; // pixels by which a place farther along must be nearer
const AROUND = [[1, 0], [-1, 0], [0, 1], [0, -1], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]];
const [MOUSE, FINGER] = [5, 18]; // pixels beside a link that still take it
const [POINT, FINGERTIP] = [10, 24]; // pixels beside a driven point that take it
const END = 3; // rows from the end of what is solved, within which an end is named

/** Lets the driven link be dragged, by mouse, pen or finger; `say(text)` hears of where it ends. */
export class Drag {
  constructor(theatre, state, player, say) {
    Object.assign(this, { theatre, state, player, say });
    this.canvas = theatre.stage.renderer.domElement;
    this.ray = new Raycaster();
    this.taken = null;
    // before the controls of the camera, which hear of it on the canvas itself
    this.canvas.parentElement.addEventListener("pointerdown", (event) => this.#take(event), true);
    this.canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, (event) => this.#drop(event));
  }

  /** What the inputs of the run drive: joints and points of the page. */
  #driven() {
    const { data, run } = this.state;
    const rows = data.tables.find((table) => table.name === "rows" && table.run === run.name);
    const names = new Set([run.x.label, ...(rows?.columns ?? []).map(({ label }) => label)].filter((each) => each.includes(".")).map((each) => each.split(".")[0]));
    return { joints: data.joints.filter(({ name }) => names.has(name)), points: data.points.filter(({ name }) => names.has(name)) };
  }

  /** The links that may be taken: those that inputs move, or all that move where these are not joints or points of the page. */
  links() {
    const { data, run } = this.state;
    if (run.kind !== "sweep") return [];
    const { joints, points } = this.#driven();
    const found = [...joints.flatMap(({ links }) => links.filter((link) => link !== 0).slice(-1)), ...points.map(({ link }) => link)];
    return found.length > 0 ? found : data.links.map((_, link) => link).slice(1);
  }

  /** The link and the place on it, as drawn, under a pointer or beside it; null where there is none to be taken. */
  #under(event, finger) {
    if (this.state.branch.poseCount < 2) return null;
    const links = this.links();
    const point = links.length > 0 ? this.#pointAt(event, finger ? FINGERTIP : POINT) : null;
    if (point) return point;
    const room = finger ? FINGER : MOUSE;
    for (const [dx, dy] of [[0, 0], ...AROUND.map((way) => way.map((each) => each * room))]) {
      const found = this.#at(event.clientX + dx, event.clientY + dy, links);
      if (found) return found;
    }
    return null;
  }

  /** A point that an input moves, where the pointer is at it, whatever is drawn there. */
  #pointAt(event, room) {
    const { mechanism, stage } = this.theatre;
    const drawn = this.state.drawnOf(this.state.branch);
    const box = this.canvas.getBoundingClientRect();
    for (const { name } of this.#driven().points) {
      const { link, place } = drawn.points.find((each) => each.name === name);
      const at = onScreen(mechanism.now(link, place).project(stage.camera), box);
      if (Math.hypot(at[0] - event.clientX + box.left, at[1] - event.clientY + box.top) <= room) return { link, place: new Vector3(...place) };
    }
    return null;
  }

  #at(x, y, links) {
    const { mechanism, stage } = this.theatre;
    this.ray.setFromCamera(this.#onStage(x, y), stage.camera);
    const [hit] = this.ray.intersectObject(mechanism.object, true).filter(({ object }) => object.isMesh && visible(object));
    const link = hit ? mechanism.links.findIndex((group) => group === hit.object.parent) : -1;
    if (!links.includes(link)) return null;
    const group = mechanism.links[link];
    const place = hit.point.clone().sub(group.position).applyQuaternion(group.quaternion.clone().invert());
    return { link, place };
  }

  #onStage(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return new Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
  }

  #take(event) {
    if (event.target !== this.canvas || event.button !== 0) return undefined;
    if (this.taken) return event.stopPropagation(); // by another finger
    const under = this.#under(event, event.pointerType !== "mouse");
    if (!under || !event.isPrimary) return undefined;
    event.stopPropagation();
    this.player.pause();
    this.taken = { ...under, pointer: event.pointerId };
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.style.cursor = "grabbing";
    return undefined;
  }

  #move(event) {
    if (!this.taken) {
      if (event.buttons === 0 && event.pointerType === "mouse") this.canvas.style.cursor = this.#under(event, false) ? "grab" : "";
      return;
    }
    if (event.pointerId !== this.taken.pointer) return;
    event.stopImmediatePropagation();
    this.latest = event;
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (this.taken) this.#follow(this.latest);
    });
  }

  #drop(event) {
    if (!this.taken || event.pointerId !== this.taken.pointer) return;
    if (this.latest) this.#follow(this.latest);
    [this.taken, this.latest] = [null, null];
    this.canvas.style.cursor = "";
    // rows are what is computed
    this.state.seek(this.state.row);
    this.say("");
  }

  /** Goes to the place of the branch whose picture of what was taken is nearest to the pointer. */
  #follow(event) {
    const { branch, place } = this.state;
    const { camera } = this.theatre.stage;
    const box = this.canvas.getBoundingClientRect();
    const pointer = [event.clientX - box.left, event.clientY - box.top];
    const seen = Array.from(branch.poseRows, (_, index) => {
      const { t, q } = branch.pose(index, this.taken.link);
      return onScreen(turned(this.taken.place, q).add(new Vector3(...t)).project(camera), box);
    });
    const whole = nearest(seen, branch, pointer, 0, seen.length - 1);
    const here = branch.poseNear(place);
    const reach = Math.max(2, Math.ceil(NEAR * seen.length));
    const around = branch.closes() ? whole : nearest(seen, branch, pointer, Math.max(0, here - reach), Math.min(seen.length - 1, here + reach));
    const found = whole.off < around.off - CLEARLY ? whole : around;
    if (found.row === null) return;
    this.state.seek(found.row);
    this.say(this.#endAt(found.row));
  }

  /** Words where the branch ends: the dead centre by its name. */
  #endAt(row) {
    const { branch, run } = this.state;
    const rows = branch.poseRows;
    const [first, last] = [rows[0], rows.at(-1)];
    if (branch.closes() || (row - first > END && last - row > END)) return "";
    const end = row - first <= END ? first : last;
    const step = Math.abs(branch.x[Math.min(branch.rows - 1, end + 1)] - branch.x[Math.max(0, end - 1)]);
    const mark = branch.marks.find(({ x }) => Math.abs(x - branch.x[end]) <= step * END);
    if (mark) return `${mark.kind.replace("-", " ")} at ${run.x.label} = ${told(mark.x)} ${run.x.unit}: ${mark.text}`;
    if (row !== end) return "";
    const beyond = end === first ? end > 0 : end < branch.rows - 1;
    return beyond ? `the branch ends at ${run.x.label} = ${told(branch.x[end])} ${run.x.unit}` : "the sweep ends here";
  }
}

/** Whether an object and all that hold it are seen: rays meet hidden ones, too. */
function visible(object) {
  for (let each = object; each; each = each.parent) if (!each.visible) return false;
  return true;
}

/** Pixels in a box of what a camera has projected. */
const onScreen = ({ x, y }, { width, height }) => [((1 + x) * width) / 2, ((1 - y) * height) / 2];

function turned(place, [w, x, y, z]) {
  const twice = new Vector3(x, y, z).cross(place).multiplyScalar(2);
  return place.clone().addScaledVector(twice, w).add(new Vector3(x, y, z).cross(twice));
}

/** The place, between poses that follow each other, that is nearest to a pointer: {row, off} in rows and pixels. */
function nearest(seen, branch, [px, py], from, to) {
  const best = { row: null, off: Infinity };
  const usual = Math.max(1, Math.ceil(branch.rows / Math.max(1, seen.length))) + 1;
  const rows = branch.poseRows;
  for (let k = from; k <= to; k += 1) {
    const [ax, ay] = seen[k];
    const joined = k < to && rows[k + 1] - rows[k] <= usual;
    const [bx, by] = joined ? seen[k + 1] : seen[k];
    const square = (bx - ax) ** 2 + (by - ay) ** 2;
    const share = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / square)) : 0;
    const off = Math.hypot(ax + share * (bx - ax) - px, ay + share * (by - ay) - py);
    if (off < best.off) Object.assign(best, { row: rows[k] + share * ((joined ? rows[k + 1] : rows[k]) - rows[k]), off });
  }
  return best;
}
