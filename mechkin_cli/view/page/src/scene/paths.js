// Paths of points over all poses of a branch, and where the points are now.

import {
  BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
  SphereGeometry,
} from "three";
import { linkColour } from "../colours.js";
import { curveThrough } from "./between.js";
import { vector } from "./vectors.js";
import { poseMatrix } from "./travel.js";

/** The paths of one branch: lines in their links' colours, smooth through the rows' places, broken where rows have no pose. */
export class Paths {
  constructor(data, branch, unit, opacity = 1) {
    this.data = data;
    this.object = new Group();
    this.dots = [];
    for (const point of data.points) {
      const colour = linkColour(data.links[point.link], point.link);
      if (point.path) this.#addPath(branch, point, colour, opacity);
      if (opacity < 1) continue;
      const dot = new Mesh(new SphereGeometry(0.42 * unit, 20, 12), new MeshBasicMaterial({ color: colour }));
      this.dots.push({ point, dot });
      this.object.add(dot);
    }
  }

  #addPath(branch, point, colour, opacity) {
    const drawn = vector(point.place);
    let stretch = [];
    const stretches = [stretch];
    const usual = Math.max(1, Math.ceil(branch.rows / Math.max(1, branch.poseCount))) + 1;
    for (let index = 0; index < branch.poseCount; index += 1) {
      if (index > 0 && branch.poseRows[index] - branch.poseRows[index - 1] > usual) {
        stretch = [];
        stretches.push(stretch);
      }
      stretch.push(drawn.clone().applyMatrix4(poseMatrix(branch.pose(index, point.link))));
    }
    for (const places of stretches) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(curveThrough(places).flatMap((place) => place.toArray()), 3));
      const material = new LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity });
      this.object.add(new Line(geometry, material));
    }
  }

  /** Puts the dots where the mechanism has them now. */
  show(mechanism) {
    for (const { point, dot } of this.dots) {
      dot.position.copy(mechanism.now(point.link, point.place));
      dot.visible = mechanism.links[point.link].visible;
    }
  }
}
