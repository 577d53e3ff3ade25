// What couplings have on their links: wheels with involute teeth or smooth, rings, bevel wheels, worms, racks, belts and screws.

import { BufferGeometry, Float32BufferAttribute, ShapeUtils, Vector2, Vector3 } from "three";
import { mergeGeometries, toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { bar, block, drawnOut, nut, once, polygon, thread } from "./parts.js";
import { frame, vector } from "./vectors.js";

const PRESSURE = (20 * Math.PI) / 180; // of the teeth that are drawn
const [ABOVE, BELOW] = [1, 1.25]; // height of teeth beyond the pitch circle and inside it, in modules
const FLANK = 4; // lines of a flank
const MOST_TEETH = 400; // more are not seen
const WORM = 2; // teeth that lean by a larger tangent are threads
const ROUND = 72; // sides of a smooth wheel
const HOLES = 5;
const CREASE = 0.6;
const SPINDLE = 0.75; // core of a spindle in joint sizes: the rail of what slides beside it is inside
const BELT = 0.3; // thickness of a belt in parts of its width

const moduleOf = ({ radius, teeth, lean }) => (2 * radius) / teeth / Math.sqrt(1 + lean * lean);
const circle = (radius, sides = ROUND, x = 0, y = 0) =>
  Array.from({ length: sides }, (_, k) => {
    const angle = (2 * Math.PI * k) / sides;
    return new Vector2(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
  });

/** The outline of a wheel with a tooth on x, counter-clockwise; of a ring the hole, whose gap between teeth is on x. */
export function outline(wheel) {
  const { radius, teeth, inner } = wheel;
  if (!teeth || teeth > MOST_TEETH) return circle(radius);
  const m = moduleOf(wheel);
  const [tip, root] = inner ? [radius + BELOW * m, radius - ABOVE * m] : [radius + ABOVE * m, Math.max(radius - BELOW * m, 0.3 * radius)];
  const base = radius * Math.cos(PRESSURE);
  const involute = (angle) => Math.tan(angle) - angle;
  const half = (at) => Math.PI / (2 * teeth) + involute(PRESSURE) - involute(Math.acos(Math.min(1, base / at)));
  const start = Math.max(base, root);
  const flank = Array.from({ length: FLANK + 1 }, (_, k) => start + ((tip - start) * k) / FLANK)
    .map((at) => [at, half(at)])
    .filter(([, angle]) => angle > 0);
  const foot = root < start ? [[root, half(start)]] : [];
  const right = [...foot, ...flank];
  const tooth = [...right.map(([at, angle]) => [at, -angle]), ...right.reverse()];
  return Array.from({ length: teeth }, (_, k) => (2 * Math.PI * k) / teeth).flatMap((turn) =>
    tooth.map(([at, angle]) => new Vector2(at * Math.cos(turn + angle), at * Math.sin(turn + angle))),
  );
}

const turned = (points, angle) => points.map((point) => point.clone().rotateAround(new Vector2(), angle));

/** What contours (the outer one first) sweep along z: at each section [z, scale, turn]. */
function lofted(contours, sections) {
  const rings = contours.map((contour, k) => (ShapeUtils.isClockWise(contour) === k > 0 ? contour : [...contour].reverse()));
  const [places, caps] = [[], []];
  const at = (point, [z, size, turn]) => {
    const moved = point.clone().rotateAround(new Vector2(), turn).multiplyScalar(size);
    return [moved.x, moved.y, z];
  };
  sections.slice(1).forEach((next, s) => {
    const here = sections[s];
    for (const ring of rings) {
      ring.forEach((point, k) => {
        const other = ring[(k + 1) % ring.length];
        const [a, b, c, d] = [at(point, here), at(other, here), at(other, next), at(point, next)];
        places.push(...a, ...b, ...c, ...a, ...c, ...d);
      });
    }
  });
  const all = rings.flat();
  for (const face of ShapeUtils.triangulateShape(rings[0], rings.slice(1))) {
    const [one, two, three] = face.map((k) => all[k]);
    const [low, high] = [sections[0], sections.at(-1)];
    caps.push(...at(three, low), ...at(two, low), ...at(one, low), ...at(one, high), ...at(two, high), ...at(three, high));
  }
  // faces are flat to their edge, however little that is broken
  return mergeGeometries([toCreasedNormals(solid(places), CREASE), solid(caps)]);
}

function solid(places) {
  const made = new BufferGeometry();
  made.setAttribute("position", new Float32BufferAttribute(places, 3));
  made.computeVertexNormals();
  return made;
}

/** Adds a wheel, ring, worm or rack to its link. */
export function addWheel(body, wheel, unit) {
  const on = frame(vector(wheel.centre), vector(wheel.axis), vector(wheel.x));
  if (wheel.reach) addRack(body, wheel);
  else if (Math.abs(wheel.lean) > WORM && wheel.teeth) addWorm(body, wheel, on);
  else body.add(solidWheel({ ...wheel, link: 0, centre: 0, axis: 0, x: 0 }, unit), on);
}

const solidWheel = once((wheel, unit) => lofted(contoursOf(wheel, unit), sectionsOf(wheel)), "wheel");

function contoursOf(wheel, unit) {
  const teeth = outline(wheel);
  if (wheel.inner) return [circle(1.12 * wheel.radius + 2 * (wheel.teeth ? moduleOf(wheel) : 0)), turned(teeth, Math.PI / (wheel.teeth || 1))];
  const root = Math.min(...teeth.map((point) => point.length()));
  const bore = Math.min(0.8 * unit, 0.35 * root);
  const holes = [circle(bore, 24)];
  const middle = (root + bore) / 2;
  const hole = 0.22 * (root - bore);
  // lightening holes, where there is room, show that it turns
  if (root > 4 * bore) {
    for (let k = 0; k < HOLES; k += 1) {
      const angle = (2 * Math.PI * (k + 0.5)) / HOLES;
      holes.push(circle(hole, 24, middle * Math.cos(angle), middle * Math.sin(angle)));
    }
  }
  return [teeth, ...holes];
}

/** Along z: a cone shrinks towards its apex, teeth that lean turn. */
function sectionsOf({ width, radius, apex, lean }) {
  const steps = Math.max(1, Math.ceil((Math.abs(lean) * width) / radius / 0.1));
  return Array.from({ length: steps + 1 }, (_, k) => {
    const z = (k / steps - 0.5) * width;
    return [z, apex ? 1 - z / apex : 1, (lean * z) / radius];
  });
}

function addWorm(body, wheel, on) {
  const { radius, teeth, lean, width } = wheel;
  const m = moduleOf(wheel);
  const lead = (2 * Math.PI * radius) / lean;
  const core = radius - BELOW * m;
  const ridge = thread(core, (ABOVE + BELOW) * m, lead, Math.abs(lead) / teeth, -width / 2, width / 2);
  body.add(bar(core, -width / 2, width / 2), on);
  // its ridge begins on x at one end, and is wanted there in the middle
  body.add(ridge.clone().rotateZ((-Math.PI * width) / lead), on);
}

/** Teeth with straight flanks along z, from where to where it is met. */
function addRack(body, wheel) {
  const { radius, teeth, width, reach } = wheel;
  const pitch = (2 * Math.PI * radius) / teeth;
  const m = pitch / Math.PI;
  const [from, to] = [Math.floor(reach[0] / pitch), Math.ceil(reach[1] / pitch)];
  const [tip, root] = [ABOVE, -BELOW].map((height) => [height * m, pitch / 4 - height * m * Math.tan(PRESSURE)]);
  const points = [[from * pitch - pitch / 2, root[0] - 2 * m], [to * pitch + pitch / 2, root[0] - 2 * m]];
  for (let k = to; k >= from; k -= 1) {
    points.push([k * pitch + root[1], root[0]], [k * pitch + tip[1], tip[0]], [k * pitch - tip[1], tip[0]], [k * pitch - root[1], root[0]]);
  }
  const [along, out] = [vector(wheel.axis), vector(wheel.x)];
  body.add(drawnOut(polygon(points), -width / 2, width / 2), frame(vector(wheel.centre), along.clone().cross(out), along));
}

/** A spindle with its thread, from its bearing to beyond where the nut comes, and the nut, about whatever holds it. */
export function addScrew(bodies, screw, unit) {
  const [from, to] = [screw.reach[0] - 2.2 * unit, screw.reach[1] + 2.2 * unit];
  const on = frame(vector(screw.centre), vector(screw.axis), vector(screw.x));
  const body = bodies[screw.link];
  body.add(bar(SPINDLE * unit, from, to), on);
  if (screw.lead) body.add(thread(SPINDLE * unit, 0.2 * unit, screw.lead, 0.5 * unit, from, to), on);
  bodies[screw.nut.link].add(nut((SPINDLE + 0.2) * unit, 1.6 * unit, -0.8 * unit, 0.8 * unit), frame(vector(screw.nut.centre), vector(screw.nut.axis)));
}

/** The disc of a cam. */
export function addDisc(body, disc, unit) {
  const half = disc.width / 2;
  const corners = disc.outline.map(([x, y]) => new Vector2(x, y));
  const inmost = Math.min(...corners.map((point) => point.length()));
  const contours = [corners, circle(Math.min(0.8 * unit, 0.35 * inmost), 24)];
  body.add(solidDisc(contours.map((contour) => contour.map(({ x, y }) => [x, y])), half), frame(vector(disc.centre), vector(disc.axis), vector(disc.x)));
}

const solidDisc = once((contours, half) =>
  lofted(contours.map((contour) => contour.map((corner) => new Vector2(...corner))), [[-half, 1, 0], [half, 1, 0]]), "disc");

/** A band along a closed line. */
export function addBelt(body, belt) {
  const axis = vector(belt.axis);
  const places = belt.line.map(vector);
  places.forEach((from, k) => {
    const along = places[(k + 1) % places.length].clone().sub(from);
    const length = along.length();
    if (length === 0) return;
    const half = [(BELT * belt.width) / 2, belt.width / 2];
    body.add(block([-half[0], -half[1], 0], [half[0], half[1], length]), frame(from, along, axis.clone().cross(along)));
  });
}

/** Places that a disc reaches. */
export function reachedByDisc(disc) {
  const on = frame(vector(disc.centre), vector(disc.axis), vector(disc.x));
  return disc.outline.filter((_, k) => k % 15 === 0).map(([x, y]) => new Vector3(x, y, 0).applyMatrix4(on));
}

/** Places that a spindle reaches. */
export function reachedByScrew(screw) {
  const on = frame(vector(screw.centre), vector(screw.axis), vector(screw.x));
  return screw.reach.map((z) => new Vector3(0, 0, z).applyMatrix4(on));
}

/** Places that a wheel reaches. */
export function reachedBy(wheel) {
  const on = frame(vector(wheel.centre), vector(wheel.axis), vector(wheel.x));
  if (wheel.reach) return wheel.reach.map((z) => new Vector3(0, 0, z).applyMatrix4(on));
  return [[1, 0], [0, 1], [-1, 0], [0, -1]].map(([x, y]) => new Vector3(1.1 * x * wheel.radius, 1.1 * y * wheel.radius, 0).applyMatrix4(on));
}
