// A link's solid: parts in the link's colour, merged so that a link is drawn at one stroke, with its edges.

import {
  BufferGeometry, EdgesGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Matrix3, Mesh, MeshStandardMaterial,
} from "three";

const EDGE_ANGLE = 38; // degrees
const EDGE_SHADE = 0.45;
const GHOST_OPACITY = 0.25;

const corners = new WeakMap(); // of parts: they are kept, so that a link whose dimensions change is made anew at once

/** Places and directions of a part's triangles, and the ends of its edges, in its own frame. */
function cornersOf(part) {
  if (!corners.has(part)) {
    const flat = part.index ? part.toNonIndexed() : part;
    const [places, normals] = ["position", "normal"].map((name) => flat.attributes[name].array);
    corners.set(part, { places, normals, edges: new EdgesGeometry(part, EDGE_ANGLE).attributes.position.array });
  }
  return corners.get(part);
}

/** Collects the parts of one link, as drawn, and makes the group that its pose moves. */
export class Body {
  #parts = [];

  /** @param matrix  the part's frame in the drawing */
  add(geometry, matrix) {
    this.#parts.push({ ...cornersOf(geometry), matrix });
  }

  /** The group, whose position and quaternion are the link's displacement from the drawing. */
  finish(colour) {
    const { group, material } = this.#solid(colour, {});
    if (!material) return group;
    const lines = new BufferGeometry();
    lines.setAttribute("position", new Float32BufferAttribute(joined(this.#parts, "edges", placed), 3));
    const edges = new LineSegments(lines, new LineBasicMaterial());
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
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(joined(this.#parts, "places", placed), 3));
    geometry.setAttribute("normal", new Float32BufferAttribute(joined(this.#parts, "normals", directed), 3));
    const material = new MeshStandardMaterial({ color, roughness: 0.55, metalness: 0.05, ...more });
    group.add(new Mesh(geometry, material));
    return { group, material };
  }
}

/** One array of what all parts have, put into their frames by `put`. */
function joined(parts, what, put) {
  const whole = new Float32Array(parts.reduce((sum, part) => sum + part[what].length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part[what], at);
    if (part.matrix) put(whole, at, at + part[what].length, part.matrix);
    at += part[what].length;
  }
  return whole;
}

function placed(whole, from, to, { elements: m }) {
  for (let k = from; k < to; k += 3) {
    const [x, y, z] = [whole[k], whole[k + 1], whole[k + 2]];
    whole[k] = m[0] * x + m[4] * y + m[8] * z + m[12];
    whole[k + 1] = m[1] * x + m[5] * y + m[9] * z + m[13];
    whole[k + 2] = m[2] * x + m[6] * y + m[10] * z + m[14];
  }
}

function directed(whole, from, to, matrix) {
  const { elements: m } = new Matrix3().getNormalMatrix(matrix);
  for (let k = from; k < to; k += 3) {
    const [x, y, z] = [whole[k], whole[k + 1], whole[k + 2]];
    const [a, b, c] = [m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z];
    const length = Math.sqrt(a * a + b * b + c * c) || 1;
    [whole[k], whole[k + 1], whole[k + 2]] = [a / length, b / length, c / length];
  }
}
