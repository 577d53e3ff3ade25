// Computes what a file's run gives with changed parameters: rows by the kernel, then cells, poses and arrows of them.

import { numbers } from "../data.js";
import { posesOf } from "./poses.js";
import { LiveTables } from "./tables.js";

const ENDS = ["complete", "other-way", "lost", "incomplete"];
const STOPS = ["", "a dead centre", "a branch point", "the end of the branch"];
const MEASURES = 5; // columns of numbers of the row behind the values

/** Computes what a file's run gives with changed parameters: a sweep, if nothing else is said. */
export class LiveRun {
  #plans = new Map(); // of other assembly modes, by their names

  /** @param live  the record of the run among the page's data */
  constructor(kernel, data, live) {
    this.data = data;
    this.live = live;
    this.shown = data.runs.find(({ name }) => name === live.run);
    [this.branch] = this.shown.branches;
    this.parameters = live.parameters;
    this.fixed = live.fixed;
    this.left = live.left;
    this.kernel = kernel;
    this.shownRows = live.rows; // of the tables
    this.plan = kernel.plan(live.plan);
    this.sizes = kernel.sizes(this.plan);
    this.count = live.rows;
    this.tapes = { numbers: kernel.tape(live.numbers), cells: kernel.tape(live.cells) };
    const { made } = kernel;
    const outputs = (tape) => made.mechkin_tape_outputs(tape);
    this.numberCount = outputs(this.tapes.numbers);
    this.cellCount = outputs(this.tapes.cells);
    this.places = {
      parameters: kernel.room(this.parameters.length),
      numbers: kernel.room(this.numberCount),
      told: kernel.room(7 + 2 * this.sizes.inputs),
      sources: kernel.room(Math.max(1, live.sources.length) * this.count),
      cells: kernel.room(this.cellCount * this.count),
    };
    // where the run writes: values, residual, condition, power error, of a response work and what was lost
    this.rows = kernel.room((this.sizes.values + MEASURES) * this.count);
    this.tables = new LiveTables(this, data.tables);
  }

  /** Values as they are in the file's units, in SI. */
  inSi(values) {
    return this.parameters.map(({ name, value, si, factor: [multiplier, divisor] }) => {
      const given = values[name] ?? value;
      if (given === value) return si;
      if (divisor !== 1) return given / divisor;
      return multiplier !== 1 ? given * multiplier : given;
    });
  }

  /**
   * What the run gives with some parameters (by name, in the file's units; others as in the file), in its own assembly mode
   * or in another one that is shown.
   * @returns {{end, words, milliseconds, branch, tables}}  branch and tables as in the page's data, not there where no row
   *   is; texts of a table are made when they are first read
   */
  compute(values, mode = this.shown.branches[0].name) {
    const start = performance.now();
    this.branch = this.shown.branches.find(({ name }) => name === mode);
    const found = this.#found(values);
    found.milliseconds = performance.now() - start;
    return found;
  }

  /** The kernel's run of the last parameters alone, for measurements. */
  runAlone() {
    this.kernel.runVariant(this.#planOf(this.branch), this.places.parameters, this.rows, this.places.told);
  }

  /** Whether another assembly mode follows the parameters. */
  follows(mode) {
    return mode in (this.live.modes ?? {});
  }

  /** The plan whose variants are continued from the file's assembly in a mode. */
  #planOf({ name, own }) {
    if (own) return this.plan;
    if (!this.#plans.has(name)) {
      const { plan, modes } = this.live;
      this.#plans.set(name, this.kernel.plan(plan.slice(0, plan.indexOf("\nvariants ") + 1) + modes[name]));
    }
    return this.#plans.get(name);
  }

  #found(values) {
    const kernel = this.kernel;
    const at = this.places;
    const given = this.inSi(values);
    if (given.some((value, k) => !isUsable(value, this.parameters[k]))) return { end: "lost", words: "a value is too large or too small to compute with" };
    kernel.doubles(at.parameters, given.length).set(given);
    try {
      const { end, words, first, last } = this.run();
      if (last <= first) return { end, words };
      kernel.runTape(this.tapes.numbers, 1, at.parameters, at.numbers);
      this.numbers = kernel.doubles(at.numbers, this.numberCount).slice();
      this.#gather();
      kernel.runTape(this.tapes.cells, this.count, at.sources, at.cells);
      return this.#result(end, words, first, last);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) return { end: "lost", words: "the page has no memory left for this" };
      throw error;
    }
  }

  /** Runs the variant: how it ended, and which of its rows are there. */
  run() {
    this.runAlone();
    const told = [...this.kernel.doubles(this.places.told, 5 + 2 * this.sizes.inputs)];
    const end = ENDS[told[0]];
    this.ends = told.slice(3, 5);
    return { end, words: this.#words(end, told), first: told[1], last: told[2] };
  }

  /** The inputs of the cells: columns of the run, and what is given. */
  #gather() {
    const kernel = this.kernel;
    const { count, sizes } = this;
    const from = kernel.doubles(this.rows, (sizes.values + MEASURES) * count);
    const to = kernel.doubles(this.places.sources, Math.max(1, this.live.sources.length) * count);
    this.live.sources.forEach(([kind, k], place) => {
      const column = to.subarray(place * count, (place + 1) * count);
      if (kind === "slot") column.set(from.subarray(k * count, (k + 1) * count));
      else if (kind === "measure") column.set(this.measure(k));
      else if (kind === "number") column.fill(this.numbers[k]);
      else column.set(this.given(k));
    });
  }

  /** A column that does not come from the run. */
  given(k) {
    const { values, first } = this.live.given[k];
    return values ? numbers(values) : this.numbers.subarray(first, first + this.count);
  }

  /** A column of the run by its slot. */
  slot(k) {
    return this.kernel.doubles(this.rows + 8 * k * this.count, this.count);
  }

  /** Residual, condition and power error; what the command does not compute is nothing. */
  measure(k) {
    const told = [true, this.live.verdict.loops, this.live.verdict.power][k];
    return told ? this.slot(this.sizes.values + k) : new Float64Array(this.count).fill(NaN);
  }

  cell(k) {
    return this.kernel.doubles(this.places.cells + 8 * k * this.count, this.count);
  }

  /** What happened at each row, in words. */
  events() {
    return [];
  }

  /** Whether the command looks more closely at the first row. */
  isDoubtful() {
    return false;
  }

  /** Marks on the axis of the run. */
  marks() {
    return [];
  }

  /** The sizes by which rounding is told, by units: they go with the largest rate of an input in rows [first, last). */
  unitSizes(first, last) {
    const { rates, kinds } = this.live.sizes;
    let largest = 0;
    for (const { cell, given, first: written, per } of rates) {
      const values = Float64Array.from(given === undefined ? this.cell(cell) : this.given(given));
      if (written) this.withFirst(values, written);
      let most = 0;
      for (let row = first; row < last; row += 1) if (Number.isFinite(values[row])) most = Math.max(most, Math.abs(values[row]));
      largest = Math.max(largest, most / per);
    }
    const sizes = { "": 1 };
    for (const [of, orders] of kinds) {
      let size = of;
      for (const [label, ...factor] of orders) {
        sizes[label] = this.fromSi(size, factor);
        size *= largest;
      }
    }
    return sizes;
  }

  /** A value in the file's units, of the conversion to SI. */
  fromSi(value, [multiplier, divisor]) {
    return divisor !== 1 ? value * divisor : value / multiplier;
  }

  texts(values, notation, digits) {
    return this.kernel.texts(values, notation, digits);
  }

  #result(end, words, first, last) {
    const judged = this.tables.verdicts(first, last, this.ends.map((stop) => (stop === 1 ? "beyond-dead-centre" : "branch-lost")));
    if (judged.doubtful || this.isDoubtful()) {
      const at = judged.doubtful ? "a row stands next to a dead centre" : "the first row stands at a limit";
      return { end: "incomplete", words: `${at}: the command looks at it more closely` };
    }
    const own = this.branch;
    const made = this.tables.made(judged.codes, first, last);
    const axis = this.live.axis === null ? own.x : made.given(this.live.axis);
    const branch = {
      rows: this.shownRows, x: axis, poses: posesOf(this, first, last), status: { ...own.status, codes: judged.codes }, marks: this.marks(axis),
      columns: made.columns(own.columns), arrows: this.#arrows(own, first, last),
    };
    return { end, words, branch, tables: made.tables };
  }

  /** What joints and drives exert, at each pose. */
  #arrows(own, first, last) {
    const { length: [multiplier, divisor], arrows } = this.live;
    return arrows.map(({ arrow, cells, place }) => {
      const base = own.arrows[arrow];
      const values = new Float32Array(3 * (last - first));
      cells.forEach((cell, k) => {
        const column = this.cell(cell);
        for (let row = first; row < last; row += 1) values[3 * (row - first) + k] = column[row];
      });
      const now = place.map((at, k) => (at === null ? base.place[k] : (this.numbers[at] * divisor) / multiplier));
      return { ...base, place: now, values };
    });
  }

  #words(end, told) {
    if (end === "complete") return "";
    if (end === "other-way") return "with these values the file is computed in another way: run the command";
    if (end === "lost") return "with these values the mechanism cannot be assembled on its branch";
    const stops = [0, 1].filter((side) => told[3 + side] > 0).map((side) => this.#stopWords(told, side));
    return stops.length > 0 ? stops.join("; ") : "some row does not close near its neighbours";
  }

  #stopWords(told, side) {
    const places = this.live.inputs.map(({ name, unit, kernel }, k) => {
      const value = told[5 + side * this.live.inputs.length + k] * kernel;
      return `${name} = ${Number(value.toPrecision(6))}${unit ? ` ${unit}` : ""}`;
    });
    return `stops at ${STOPS[told[3 + side]]}, ${places.join(", ")}`;
  }
}

/** Whether a value in SI is a number that the command takes, too. */
function isUsable(value, { least = 0, most = Number.MAX_VALUE }) {
  const size = Math.abs(value);
  return value === 0 || (size >= least && size <= most);
}
