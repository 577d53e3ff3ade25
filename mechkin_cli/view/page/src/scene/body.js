// A link's solid: parts in the link's colour, merged so that a link is drawn at one stroke, with its edges.

import {
  EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshStandardMaterial,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";

const EDGE_ANGLE = 38; // degrees
const EDGE_SHADE = 0.45;
const GHOST_OPACITY = 0.25;

/** Collects the parts of one link, as drawn, and makes the group that its pose moves. */
export class Body {
  #parts = [];

  /** @param matrix  the part's frame in the drawing */
  add(geometry, matrix) {
    const part = geometry.index ? geometry.toNonIndexed() : geometry.clone();
    part.deleteAttribute("uv");
    if (matrix) part.applyMatrix4(matrix);
    this.#parts.push(part);
  }

  /** The group, whose position and quaternion are the link's displacement from the drawing. */
  finish(colour) {
    const { group, geometry, material } = this.#solid(colour, {});
    if (!geometry) return group;
    const edges = new LineSegments(new EdgesGeometry(geometry, EDGE_ANGLE), new LineBasicMaterial());
    edges.material.color.copy(material.color).multiplyScalar(EDGE_SHADE);
    group.add(edges);
    return group;
  }

  /** The same, pale and without edges. */
  ghost(colour) {
    // set back a little, so that what lies in the same place as the mechanism does not show through it
    const back = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4 };
    return this.#solid(colour, { transparent: true, opacity: GHOST_OPACITY, depthWrite: false, ...back }).group;
  }

  #solid(color, more) {
    const group = new Group();
    if (this.#parts.length === 0) return { group };
    const geometry = mergeGeometries(this.#parts);
    const material = new MeshStandardMaterial({ color, roughness: 0.55, metalness: 0.05, ...more });
    group.add(new Mesh(geometry, material));
    return { group, geometry, material };
  }
}
