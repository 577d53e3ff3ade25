// A response with changed parameters: its first assembly is continued from the file's, and it moves from there.

import { LiveRun } from "./run.js";

const [WORK, LOST, ENERGY] = [3, 4, 5]; // measures of a response, behind those of a sweep
const SHORT = 15; // significant digits of a number that is written

/** Computes what a file's response gives with changed parameters. */
export class LiveResponse extends LiveRun {
  #start;

  constructor(kernel, data, live) {
    super(kernel, data, live);
    this.#start = kernel.plan(live.start);
  }

  runAlone() {
    this.kernel.respond(this.#start, this.plan, this.places.parameters, this.rows, this.places.told);
  }

  /** Runs the response: how it ended, and which of its rows are there. */
  run() {
    this.runAlone();
    const [end, rows, reached, stop, time, energy, moments] = this.kernel.doubles(this.places.told, 7);
    Object.assign(this, { shownRows: rows, stop, time, energy, moments, ends: [0, 0] });
    const words = ["", "with these values the file is computed in another way: run the command",
      "with these values the mechanism cannot be assembled on its branch",
      `the motion ends after ${this.#timeText(time)}: run the command, which says why`][end];
    return { end: ["complete", "other-way", "lost", "incomplete"][end], words, first: 0, last: end === 0 ? reached : 0 };
  }

  #timeText(time) {
    const { unit } = this.shown.x;
    const told = `${Number(this.fromSi(time, this.live.response.factor).toPrecision(6))}`;
    return unit ? `${told} ${unit}` : told;
  }

  /** As of a sweep; the last row of a response that a stop ends has that one's time. */
  given(k) {
    const { time, written, factor } = this.live.response;
    const own = super.given(k);
    if (this.stop < 0 || (k !== time && k !== written)) return own;
    const kept = Float64Array.from(own);
    if (this.shownRows > this.moments) kept[this.shownRows - 1] = k === time ? this.time : this.fromSi(this.time, factor);
    return kept;
  }

  /** At a limit where it starts, a motion may end at once. */
  isDoubtful() {
    return this.live.verdict.limits.some(({ cell, ends, slack }) => {
      const [value] = this.cell(cell);
      return ends.some((end) => end !== null && Math.abs(value - this.numbers[end]) <= slack);
    });
  }

  measure(k) {
    if (k < WORK) return super.measure(k);
    if (k < ENERGY) return this.slot(this.sizes.values + k);
    return this.#energyError();
  }

  /** What is missing of the balance of energies, in parts of the largest of them. */
  #energyError() {
    const { energies, rounding } = this.live.response;
    const [kinetic, potential] = energies.map((slot) => this.slot(slot));
    const [work, lost] = [WORK, LOST].map((k) => this.slot(this.sizes.values + k));
    const found = new Float64Array(this.count).fill(NaN);
    let largest = 0;
    let size = 0;
    for (let row = 0; row < this.shownRows; row += 1) {
      for (const part of [kinetic[row], potential[row] - potential[0], work[row], lost[row]]) largest = Math.max(largest, Math.abs(part));
      size = Math.max(size, Math.abs(potential[row]));
    }
    largest = Math.max(largest, this.energy);
    if (!(largest > 0)) return found;
    for (let row = 0; row < this.shownRows; row += 1) {
      const missing = kinetic[row] - kinetic[0] + (potential[row] - potential[0]) - (work[row] - lost[row]);
      found[row] = Math.max(Math.abs(missing) - rounding * size, 0) / largest;
    }
    return found;
  }

  /** A column of a start's coordinate: the first row has it as the file writes it. */
  withFirst(values, { si, factor: [multiplier, divisor] }) {
    const short = Number(values[0].toPrecision(SHORT));
    const back = divisor !== 1 ? short / divisor : multiplier !== 1 ? short * multiplier : short;
    if (back === this.numbers[si]) values[0] = short;
    return values;
  }

  /** The event of each row: the stop that has ended the response, at its last one. */
  events() {
    const words = new Array(this.shownRows).fill("");
    if (this.stop >= 0) words[this.shownRows - 1] = this.live.response.stops[this.stop];
    return words;
  }

  marks(x) {
    const event = this.events().at(-1);
    return event ? [{ x: x[this.shownRows - 1], kind: "event", text: event }] : [];
  }
}
