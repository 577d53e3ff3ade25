// How each type of joint is drawn: its two halves, each into its own link's body.
// Lengths are in units of the joint's size u; `travel[k]` is where the other half's point comes to, in half k's frame.

import { bar, ball, block, nut, shell, sleeve, squareTube, thread, trough, turnedOutline } from "./parts.js";
import { addShell, addSlot, addTrough } from "./tracks.js";
import { frame, vector } from "./vectors.js";

const HOLD = 1.2; // half the length of what slides, over the travel
const STOP = 0.4; // thickness of a stop

function revolute({ joint, first, second, u }) {
  dial(first, second, joint.stops, u);
  first.add(bar(0.5 * u, -1.45 * u, 1.45 * u));
  second.add(sleeve(0.5 * u, 0.95 * u, -0.9 * u, 0.9 * u));
  if (first.across) {
    first.fork(1, first.ground ? 2.1 : 1.5);
    first.foot(2.1 * u);
  } else {
    first.add(bar(0.85 * u, -1.7 * u, -1.35 * u));
    first.add(bar(0.85 * u, 1.35 * u, 1.7 * u));
    first.post(2.6 * u);
  }
  second.post(2.1 * u);
}

/** The reach along z of a rail on which the other half slides: from its own link's joint on. */
function reach({ least, most }, u, margin = 2.2) {
  return [Math.min(0, least.z) - margin * u, Math.max(0, most.z) + margin * u];
}

/** Blocks that carry the ends of a rail on the ground. */
function railEnds(half, [from, to], u) {
  if (!half.ground) return;
  for (const z of [from, to]) half.add(block([-0.9 * u, -0.9 * u, z - 0.3 * u], [0.9 * u, 0.9 * u, z + 0.3 * u]));
}

const upright = (axis) => Math.abs(axis.z) > 0.999;

/** Blocks on a rail where `limits:` stop what slides on it, which holds it `hold` to both sides; the rail with them. */
function stopped(half, [low, high], rail, hold, u) {
  const [from, to] = rail;
  const blocks = [];
  if (low !== null) blocks.push([low - hold - STOP * u, low - hold]);
  if (high !== null) blocks.push([high + hold, high + hold + STOP * u]);
  for (const [begin, end] of blocks) half.add(block([-0.85 * u, -0.85 * u, begin], [0.85 * u, 0.85 * u, end]));
  return [Math.min(from, ...blocks.map(([begin]) => begin)), Math.max(to, ...blocks.map(([, end]) => end))];
}

/** A hand on the second half and, on the first, the arc that `limits:` leave it, with a stop at each end. */
function dial(first, second, { turn }, u) {
  if (!turn) return;
  const [low, high] = turn;
  if (low !== null && high !== null && high - low > 2 * Math.PI - 0.5) return;
  const hand = second.across ?? second.x;
  const at = Math.atan2(hand.dot(second.y), hand.dot(second.x));
  const [levels, radii] = [[1.5 * u, 1.75 * u], [1.05 * u, 1.35 * u]];
  const half = 0.16;
  const [from, to] = [low ?? high - 1, high ?? low + 1].map((angle) => angle + at);
  const arc = (start, end, [inner, outer], [below, above]) =>
    first.add(turnedOutline([[inner, below], [outer, below], [outer, above], [inner, above]], end - start, start + Math.PI / 2));
  arc(from - half, to + half, radii, levels);
  const stop = [[radii[0], 1.6 * u], [levels[0], levels[1] + 0.25 * u]];
  if (low !== null) arc(from - half - 0.3, from - half, ...stop);
  if (high !== null) arc(to + half, to + half + 0.3, ...stop);
  const pointer = frame(second.point, second.axis, hand);
  second.add(bar(0.3 * u, 0, levels[1] + 0.2 * u));
  second.add(block([0, -0.13 * u, levels[1]], [1.5 * u, 0.13 * u, levels[1] + 0.2 * u]), pointer);
}

function prismatic({ stops, first, second, u, travel }) {
  const rail = stopped(first, stops, reach(travel[0], u), HOLD * u, u);
  first.add(block([-0.5 * u, -0.5 * u, rail[0]], [0.5 * u, 0.5 * u, rail[1]]));
  railEnds(first, rail, u);
  second.add(squareTube(0.52 * u, 0.95 * u, -HOLD * u, HOLD * u));
  second.post(2.4 * u);
}

function cylindric({ stops, first, second, u, travel }) {
  const rail = stopped(first, stops, reach(travel[0], u), HOLD * u, u);
  first.add(bar(0.5 * u, ...rail));
  railEnds(first, rail, u);
  second.add(sleeve(0.52 * u, 0.95 * u, -HOLD * u, HOLD * u));
  second.post(2.4 * u);
}

function helical({ joint, stops, first, second, u, travel }) {
  const screw = stopped(first, stops, reach(travel[0], u), 0.9 * u, u);
  first.add(bar(0.42 * u, ...screw));
  if (joint.lead) first.add(thread(0.42 * u, 0.2 * u, joint.lead, 0.5 * u, ...screw));
  railEnds(first, screw, u);
  second.add(nut(0.62 * u, 1.15 * u, -0.9 * u, 0.9 * u));
  second.post(2.4 * u);
}

function spherical({ first, second, u }) {
  first.add(ball(0.8 * u), first.at(0, 0, 0));
  first.post(2.1 * u);
  const towards = frame(second.point, second.stem);
  second.add(shell(0.84 * u, 1.12 * u, 0, Math.PI / 2), towards);
  second.post(2.1 * u);
}

/** Each link has a fork, and the cross's pins turn in the forks: each pin is round, so it may be its own link's. */
function universal({ first, second, u }) {
  for (const half of [first, second]) {
    half.add(bar(0.34 * u, -1.5 * u, 1.5 * u));
    if (half.across) half.fork(0.95, half.ground ? 2.6 : 2.1, 0.36);
    half.foot(2.6 * u);
  }
  second.add(ball(0.55 * u));
}

/** The box in which the other half's point comes on this half's plane, from its own link's joint on, with a margin. */
function spread({ least, most }, margin) {
  return [
    [Math.min(0, least.x) - margin, Math.min(0, least.y) - margin],
    [Math.max(0, most.x) + margin, Math.max(0, most.y) + margin],
  ];
}

/** A thin plate in the half's x and y, its face at z = `face`, on the side of its link. */
function plate(half, box, margin, face, u) {
  const side = half.stem.dot(half.axis) >= 0 ? 1 : -1;
  const [low, high] = spread(box, margin);
  const levels = [side * face, side * (face + 0.3 * u)].sort((a, b) => a - b);
  half.add(block([...low, levels[0]], [...high, levels[1]]));
  half.post(1.8 * u + face);
}

function sphereOnPlane({ joint, first, second, u, travel }) {
  first.add(ball(0.8 * u));
  first.post(2.1 * u);
  if (joint.track) {
    addShell(second, joint.track, u);
    return;
  }
  plate(second, travel[1], 1.5 * u, 0.8 * u, u);
}

function sphereInGroove({ joint, first, second, u, travel, flat }) {
  if (joint.track && flat) {
    first.add(bar(0.55 * u, -1.2 * u, 1.2 * u));
    addSlot(second, joint.track, first.axis, u);
    return;
  }
  if (joint.track) {
    first.add(ball(0.8 * u));
    first.post(2.1 * u);
    addTrough(second, joint.track, u);
    return;
  }
  if (flat && upright(first.axis) && !upright(second.axis)) {
    // a pin in a slot is seen from above: walls beside it, no trough
    first.add(bar(0.55 * u, -1.2 * u, 1.2 * u));
    const row = reach(travel[1], u, 1.4).map((z) => second.point.clone().addScaledVector(second.axis, z).toArray());
    addSlot(second, { rows: [row], closed: false }, first.axis, u);
    return;
  }
  first.add(ball(0.8 * u));
  first.post(2.1 * u);
  const open = frame(second.point, second.axis, (second.across ?? second.x).clone().negate());
  second.add(trough(0.83 * u, 1.1 * u, ...reach(travel[1], u, 1.4)), open);
  second.foot(1.1 * u);
}

function planar({ first, second, u, travel }) {
  const side = second.stem.dot(second.axis) >= 0 ? 1 : -1;
  const slab = (half, low, high, from, to) => {
    const levels = [side * from * u, side * to * u].sort((a, b) => a - b);
    half.add(block([...low, levels[0]], [...high, levels[1]]));
  };
  slab(first, ...spread(travel[0], 1.6 * u), -0.3, 0);
  slab(second, [-1.2 * u, -1.2 * u], [1.2 * u, 1.2 * u], 0, 0.4);
  first.post(2.1 * u);
  second.post(2.1 * u);
}

function weld({ first, second, u }) {
  first.add(shell(0.02 * u, 0.75 * u, 0, Math.PI / 2));
  second.add(shell(0.02 * u, 0.75 * u, Math.PI / 2, Math.PI));
  first.post(2.1 * u);
  second.post(2.1 * u);
}

/** Two caps hold the ball; between them is the slot, in which the pin stays. */
function slottedSphere({ first, second, u }) {
  first.add(shell(0.84 * u, 1.15 * u, 0.3, 1.1));
  first.add(shell(0.84 * u, 1.15 * u, Math.PI - 1.1, Math.PI - 0.3));
  first.post(2.1 * u);
  second.add(ball(0.8 * u));
  second.add(bar(0.3 * u, -1.7 * u, 1.7 * u));
  second.post(2.1 * u);
}

/** A pipe slotted along its axis, in which the ball slides, its pin out of the slot. */
function slottedCylinder({ joint, first, second, u, travel }) {
  const slot = joint.halves[0].axis2 ? vector(joint.halves[0].axis2) : second.axis;
  const pipe = frame(first.point, first.axis, slot);
  first.add(trough(0.84 * u, 1.15 * u, ...reach(travel[0], u, 1.4), 0.9), pipe);
  first.foot(1.1 * u);
  second.add(ball(0.8 * u));
  second.add(bar(0.3 * u, 0, 1.9 * u));
}

function cylinderOnPlane({ first, second, u, travel }) {
  first.add(bar(0.8 * u, -2 * u, 2 * u));
  first.post(2.1 * u);
  plate(second, travel[1], 2.4 * u, 0.8 * u, u);
}

/** What draws a joint of each type. */
export const PAIRS = new Map(Object.entries({
  R: revolute,
  P: prismatic,
  C: cylindric,
  H: helical,
  S: spherical,
  U: universal,
  Sp: sphereOnPlane,
  Sg: sphereInGroove,
  E: planar,
  W: weld,
  Ss: slottedSphere,
  Sc: slottedCylinder,
  Cp: cylinderOnPlane,
  F: () => {},
}));
