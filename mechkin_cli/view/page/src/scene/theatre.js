// What is on the stage: the mechanism at the row that is shown, ghosts of other modes, paths, arrows, names.

import { curveColour } from "../colours.js";
import { Arrows } from "./arrows.js";
import { posesAt } from "./between.js";
import { Cables } from "./cables.js";
import { Labels } from "./labels.js";
import { Mechanism, jointUnit } from "./mechanism.js";
import { Paths } from "./paths.js";
import { Stage, dispose } from "./stage.js";
import { Ties } from "./ties.js";
import { vector } from "./vectors.js";
import { diagonal, firstDirection, placesOf, withRoom } from "./viewpoint.js";

const FLOOR = 2.6; // below the lowest joint, in joint sizes
const LOST = 0.35; // opacity of the mechanism in a row without position
const BEFORE = "#8b929c"; // the mechanism with the file's dimensions, behind the one with changed ones

/** Draws the state. */
export class Theatre {
  constructor(host, state) {
    this.state = state;
    this.data = state.data;
    this.stage = new Stage(host, state.data);
    this.labels = new Labels(host.querySelector(".names"));
    this.shown = { names: true, paths: true, floor: true };
    this.arrowNames = null;
    this.ghosts = [];
    this.hidden = new Set(this.data.links.flatMap(({ hidden }, link) => (hidden ? [link] : [])));
    this.noPose = host.querySelector("#no-pose");
    [this.noRoom, this.tools, this.legend] = ["#no-room", "#tools", "#legend"].map((each) => host.querySelector(each));
    this.old = [];
    this.stage.afterDraw = () => {
      this.#name();
      this.old.splice(0).forEach(dispose);
    };
    this.stage.whenSized = () => this.home();
    // until somebody turns or moves it, the view fits the stage, however large that becomes
    this.stage.whenResized = () => this.fitted && this.lookFrom(this.fitted);
    this.stage.controls.addEventListener("start", () => (this.fitted = null));
    state.watch((changes) => this.#change(changes));
  }

  #change(changes) {
    if (changes.has("run")) this.#open();
    if (changes.has("branch") || changes.has("run")) {
      this.#dress();
      this.#fit();
    } else if (changes.has("dimensions")) {
      this.#dress();
    }
    if (changes.has("compare") || changes.has("branch")) this.#compare();
    this.#pose();
  }

  /** Sizes of what is drawn, from the run's own branch; the mechanisms of a run are made when they are first shown. */
  #open() {
    for (const made of this.mechanisms?.values() ?? []) dispose(made.object);
    this.mechanisms = new Map();
    const own = placesOf(this.data, this.state.branches()[0]);
    this.size = diagonal(own) || this.data.size || 1;
    this.unit = jointUnit(this.data, this.size);
  }

  /** The branch's mechanism, paths and arrows. */
  #dress() {
    const { scene } = this.stage;
    const { branch, run } = this.state;
    const data = this.state.drawnOf(branch);
    const zoom = this.arrows?.zoom ?? 1;
    const before = this.mechanism;
    for (const old of [this.paths, this.ties]) this.#discard(old?.object);
    this.mechanism = this.#mechanismOf(branch, data);
    if (before !== this.mechanism) before?.object.removeFromParent();
    this.mechanism.links.forEach((group, link) => (group.visible = !this.hidden.has(link)));
    this.drawn = data;
    this.paths = new Paths(data, branch, this.unit);
    if (!this.arrows?.turnTo(branch)) {
      this.#discard(this.arrows?.object);
      this.arrows = new Arrows(data, branch, this.unit, this.size);
      this.arrows.zoom = zoom;
    }
    this.ties = new Ties(data.ties?.[run.name] ?? data.runs[this.data.runs.indexOf(run)].ties, data, branch, this.unit);
    if (this.cables?.cables !== data.cables || this.cables.unit !== this.unit) {
      this.#discard(this.cables?.object);
      this.cables = new Cables(data.cables, this.unit);
    }
    this.#choose();
    scene.add(this.cables.object, this.mechanism.object, this.paths.object, this.arrows.object, this.ties.object);
  }

  /** Takes an object off, and gives its memory back after the next picture: what that shares with it need not be made again. */
  #discard(object) {
    if (!object) return;
    object.removeFromParent();
    this.old.push(object);
  }

  /** The bodies of a branch. */
  #mechanismOf(branch, data) {
    if (data !== this.data) {
      this.#discard(this.changed?.object);
      this.changed = new Mechanism(data, branch, this.unit);
      return this.changed;
    }
    if (!this.mechanisms.has(branch)) this.mechanisms.set(branch, new Mechanism(data, branch, this.unit));
    return this.mechanisms.get(branch);
  }

  /** Where the branch comes to; the view stays unless something is out of it. */
  #fit() {
    const { branch } = this.state;
    this.places = placesOf(this.drawn, branch);
    this.floorHeight = Math.min(...this.places.map((place) => place.dot(this.stage.up))) - FLOOR * this.unit;
    this.#floor();
    if (this.stage.width && !this.stage.sees(this.places)) this.home();
  }

  #floor() {
    this.stage.setFloor(this.shown.floor ? this.floorHeight : null);
  }

  #choose() {
    for (const each of this.arrows.all) each.shown = this.arrowNames?.has(each.arrow.name) ?? false;
  }

  /** The mechanism in the other modes, and with the file's own dimensions, pale, each with its paths. */
  #compare() {
    for (const { mechanism, paths } of this.ghosts) {
      dispose(mechanism.object);
      dispose(paths.object);
    }
    this.ghosts = [];
    const { shownOriginal, compare, branch: shown } = this.state;
    const all = this.state.branches();
    const others = compare ? all.filter((branch) => branch !== shown && branch.poseCount > 0) : [];
    for (const branch of [...(shownOriginal ? [shownOriginal] : []), ...others]) {
      const colour = branch === shownOriginal ? BEFORE : curveColour(all.indexOf(branch));
      const data = this.state.drawnOf(branch);
      const mechanism = new Mechanism(data, branch, this.unit, colour);
      const paths = new Paths(data, branch, this.unit, 0.4);
      this.stage.scene.add(mechanism.object, paths.object);
      this.ghosts.push({ branch, mechanism, paths });
    }
  }

  #pose() {
    const { branch, place, row } = this.state;
    const { index, next, share } = posesAt(branch, place);
    this.noPose.hidden = index >= 0;
    this.mechanism.object.visible = index >= 0;
    this.paths.object.visible = index >= 0 && this.shown.paths;
    this.arrows.object.visible = index >= 0;
    this.ties.object.visible = index >= 0;
    this.cables.object.visible = index >= 0;
    if (index >= 0) this.mechanism.show(branch, index, next, share);
    this.#fade(index < 0 || !this.#hasPose(branch, row));
    if (index >= 0) {
      this.paths.show(this.mechanism);
      this.arrows.show(this.mechanism, index);
      this.ties.show(this.mechanism);
      this.cables.show(this.mechanism);
    }
    for (const { branch: other, mechanism } of this.ghosts) {
      const at = other.poseNear(other.rows === branch.rows ? row : other.rowAt(branch.x[row]));
      mechanism.object.visible = at >= 0;
      if (at >= 0) mechanism.show(other, at);
    }
    this.stage.ask();
  }

  /** Whether the pose that is drawn is the row's, or as near as the thinned poses come. */
  #hasPose(branch, row) {
    const stride = Math.max(1, Math.ceil(branch.rows / Math.max(1, branch.poseCount)));
    return Math.abs(branch.poseRows[branch.poseNear(row)] - row) <= (stride > 1 ? stride : 0);
  }

  /** A row without a position shows the last one that has, pale. */
  #fade(lost) {
    if (this.lost === lost && this.faded === this.mechanism) return;
    [this.lost, this.faded] = [lost, this.mechanism];
    this.mechanism.object.traverse((each) => {
      if (!each.material) return;
      each.material.transparent = lost;
      each.material.opacity = lost ? LOST : 1;
      each.material.needsUpdate = true;
    });
  }

  #name() {
    const { camera, width, height } = this.stage;
    const wanted = [];
    if (this.shown.names && width && this.mechanism.object.visible) {
      for (const joint of this.drawn.joints) {
        const k = this.mechanism.links[joint.links[0]].visible ? 0 : 1;
        if (!this.mechanism.links[joint.links[k]].visible) continue;
        const place = this.mechanism.now(joint.links[k], joint.halves[k].point);
        wanted.push({ key: `joint ${joint.name}`, text: joint.name, places: [place], kind: "joint" });
      }
      for (const { name, link, place } of this.drawn.points) {
        if (!this.mechanism.links[link].visible) continue;
        wanted.push({ key: `point ${name}`, text: name, places: [this.mechanism.now(link, place)], kind: "point" });
      }
    }
    const arrows = this.arrows.all.filter(({ group, tip }) => group.visible && tip);
    for (const { arrow, group, magnitude, tip } of this.arrows.object.visible ? arrows : []) {
      // what a name says in brackets stands in the list of arrows
      const name = arrow.name.replace(/ \(.*\)$/, "*");
      wanted.unshift({
        key: `arrow ${arrow.name}`, text: `${name} ${magnitude.toPrecision(4)} ${arrow.unit}`, places: [tip, group.position], kind: arrow.kind,
      });
    }
    const left = this.labels.show(wanted, camera, width, height, this.#covered()).filter((key) => key.startsWith("arrow ")).length;
    this.noRoom.hidden = left === 0;
    this.noRoom.style.top = `${this.tools.offsetTop + this.tools.offsetHeight + 4}px`;
    this.noRoom.textContent = `${left} of ${arrows.length} values have no room: come nearer, or choose fewer under forces`;
  }

  /** Boxes of what lies over the stage, and of the note below it. */
  #covered() {
    const parts = [...this.tools.children, ...this.legend.children, this.noRoom];
    const { left, top } = this.stage.host.getBoundingClientRect();
    return parts.map((part) => part.getBoundingClientRect()).filter(({ width }) => width > 0)
      .map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top]);
  }

  /** Looks from where the page looked first, so that everything is seen. */
  home() {
    this.places = placesOf(this.drawn, this.state.branch);
    this.lookFrom(firstDirection(this.drawn, this.places));
  }

  /** Looks along one of the ground axes, or another direction. */
  lookFrom(direction) {
    this.fitted = direction;
    const room = 2.6 * this.unit;
    const back = direction instanceof Array ? vector(direction) : direction;
    const compared = this.ghosts.flatMap(({ branch }) => placesOf(this.state.drawnOf(branch), branch));
    this.stage.look(back, withRoom([...this.places, ...compared], room));
  }

  /** Looks along a direction, or as a camera did that somebody has moved; now, or when the stage has its size. */
  keepView({ look, camera }) {
    const go = () => {
      if (look) this.lookFrom(look);
      else this.fitted = null;
      if (!look) this.stage.moveTo(camera);
    };
    if (this.stage.width) go();
    else this.stage.whenSized = go;
  }

  setShown(what, on) {
    this.shown[what] = on;
    this.paths.object.visible = this.shown.paths;
    this.#floor();
    this.stage.ask();
  }

  setLinkVisible(link, on) {
    if (on) this.hidden.delete(link);
    else this.hidden.add(link);
    this.mechanism.links[link].visible = on;
    this.#pose();
  }

  /** @param names  a Set of the arrows that are shown */
  setArrows(names) {
    this.arrowNames = names;
    this.#choose();
    this.#pose();
  }

  setArrowZoom(zoom) {
    this.arrows.zoom = zoom;
    this.#pose();
  }

  /** The pose as drawn now. */
  pose(link) {
    const { position, quaternion } = this.mechanism.links[link];
    return { t: position.toArray(), q: [quaternion.w, quaternion.x, quaternion.y, quaternion.z] };
  }
}
