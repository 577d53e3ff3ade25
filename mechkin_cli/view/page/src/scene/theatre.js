// What is on the stage: the mechanism at the row that is shown, ghosts of other modes, paths, arrows, names.

import { CURVES } from "../colours.js";
import { Arrows } from "./arrows.js";
import { posesAt } from "./between.js";
import { Labels } from "./labels.js";
import { Mechanism } from "./mechanism.js";
import { Paths } from "./paths.js";
import { Stage } from "./stage.js";
import { vector } from "./vectors.js";
import { firstDirection, placesOf, withRoom } from "./viewpoint.js";

const FLOOR = 2.6; // below the lowest joint, in joint sizes
const LOST = 0.35; // opacity of the mechanism in a row without position

/** Draws the state. */
export class Theatre {
  constructor(host, state) {
    this.state = state;
    this.data = state.data;
    this.stage = new Stage(host, state.data);
    this.labels = new Labels(host.querySelector(".names"));
    this.shown = { names: true, paths: true, floor: true };
    this.arrowNames = null;
    this.noPose = host.querySelector("#no-pose");
    this.stage.afterDraw = () => this.#name();
    this.stage.whenSized = () => this.home();
    state.watch((changes) => this.#change(changes));
  }

  #change(changes) {
    if (changes.has("run")) this.#build();
    if (changes.has("branch") || changes.has("run")) this.#dress();
    if (changes.has("compare") || changes.has("branch")) this.#compare();
    this.#pose();
  }

  /** The mechanism of a run, with rails as long as its travels. */
  #build() {
    const { scene } = this.stage;
    if (this.mechanism) scene.remove(this.mechanism.object);
    const hidden = this.mechanism?.links.map((group) => !group.visible);
    const branches = this.state.branches();
    this.mechanism = new Mechanism(this.data, branches);
    hidden?.forEach((off, link) => (this.mechanism.links[link].visible = !off));
    scene.add(this.mechanism.object);
    this.places = placesOf(this.data, [branches[0]]);
    const heights = this.places.map((place) => place.dot(this.stage.up));
    this.floorHeight = Math.min(...heights) - FLOOR * this.mechanism.unit;
    this.#floor();
  }

  #floor() {
    this.stage.setFloor(this.shown.floor ? this.floorHeight : null);
  }

  /** Paths and arrows of the branch. */
  #dress() {
    const { scene } = this.stage;
    for (const old of [this.paths, this.arrows]) {
      if (!old) continue;
      scene.remove(old.object);
      old.dispose();
    }
    this.paths = new Paths(this.data, this.state.branch, this.mechanism.unit);
    this.paths.object.visible = this.shown.paths;
    const zoom = this.arrows?.zoom ?? 1;
    this.arrows = new Arrows(this.data, this.state.branch, this.mechanism.unit);
    this.arrows.zoom = zoom;
    this.#choose();
    scene.add(this.paths.object, this.arrows.object);
  }

  #choose() {
    for (const each of this.arrows.all) each.shown = this.arrowNames?.has(each.arrow.name) ?? false;
  }

  /** Pale copies of the mechanism in the other modes, each with its paths. */
  #compare() {
    for (const { mechanism, paths } of this.ghosts ?? []) {
      this.stage.scene.remove(mechanism.object, paths.object);
      paths.dispose();
    }
    this.ghosts = [];
    if (!this.state.compare) return;
    this.state.branches().forEach((branch, k) => {
      if (branch === this.state.branch) return;
      const mechanism = this.mechanism.ghost(CURVES[k % CURVES.length]);
      const paths = new Paths(this.data, branch, this.mechanism.unit, 0.4);
      this.ghosts.push({ branch, mechanism, paths });
      this.stage.scene.add(mechanism.object, paths.object);
    });
  }

  #pose() {
    const { branch, place, row } = this.state;
    const { index, next, share } = posesAt(branch, place);
    this.noPose.hidden = index >= 0;
    this.mechanism.object.visible = index >= 0;
    this.paths.object.visible = index >= 0 && this.shown.paths;
    this.arrows.object.visible = index >= 0;
    if (index >= 0) this.mechanism.show(branch, index, next, share);
    this.#fade(index < 0 || !this.#hasPose(branch, row));
    if (index >= 0) {
      this.paths.show(this.mechanism);
      this.arrows.show(this.mechanism, index);
    }
    for (const { branch: other, mechanism } of this.ghosts ?? []) {
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
      for (const joint of this.data.joints) {
        const k = this.mechanism.links[joint.links[0]].visible ? 0 : 1;
        if (!this.mechanism.links[joint.links[k]].visible) continue;
        const place = this.mechanism.now(joint.links[k], joint.halves[k].point);
        wanted.push({ key: `joint ${joint.name}`, text: joint.name, places: [place], kind: "joint" });
      }
      for (const { name, link, place } of this.data.points) {
        if (!this.mechanism.links[link].visible) continue;
        wanted.push({ key: `point ${name}`, text: name, places: [this.mechanism.now(link, place)], kind: "point" });
      }
    }
    for (const { arrow, group, magnitude, tip } of this.arrows.all) {
      if (!group.visible || !tip) continue;
      wanted.unshift({
        key: `arrow ${arrow.name}`, text: `${arrow.name} ${magnitude.toPrecision(4)} ${arrow.unit}`, places: [tip, group.position], kind: arrow.kind,
      });
    }
    this.labels.show(wanted, camera, width, height);
  }

  /** Looks from where the page looked first, so that everything is seen. */
  home() {
    this.lookFrom(firstDirection(this.data, this.places));
  }

  /** Looks along one of the ground axes, or another direction. */
  lookFrom(direction) {
    const room = 2.6 * this.mechanism.unit;
    const back = direction instanceof Array ? vector(direction) : direction;
    this.stage.look(back, withRoom(this.places, room));
  }

  setShown(what, on) {
    this.shown[what] = on;
    this.paths.object.visible = this.shown.paths;
    this.#floor();
    this.stage.ask();
  }

  setLinkVisible(link, on) {
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
