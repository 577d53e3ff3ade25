// The kernel that computes in the page: WebAssembly made of the sources that the command is made of (kernel/wasm).

import { numbers } from "../data.js";
import { LiveTables } from "./tables.js";
import { posesOf } from "./poses.js";

const MESSAGE = 256;
const ENDS = ["complete", "other-way", "lost", "incomplete"];
const STOPS = ["", "a dead centre", "a branch point", "the end of the branch"];
const NOTATIONS = { shortest: 0, fixed: 1, trimmed: 2, scientific: 3 };

/** The kernel, or null where the page has none, or the browser cannot run it. */
export async function loadKernel() {
  const packed = globalThis.document?.getElementById("mechkin-kernel")?.textContent.trim();
  if (!packed || typeof WebAssembly !== "object" || typeof DecompressionStream !== "function") return null;
  try {
    const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return await kernelOf(await new Response(stream).arrayBuffer());
  } catch {
    return null; // without SIMD the module is refused
  }
}

/** The kernel of the bytes of a module. */
export async function kernelOf(bytes) {
  const stop = () => { throw new Error("the kernel stopped"); };
  const { instance } = await WebAssembly.instantiate(bytes, {
    // what a C library may ask of a system: nothing of it is used but to stop
    wasi_snapshot_preview1: new Proxy({}, { get: (_, name) => (name === "fd_write" ? () => 8 : name.startsWith("environ") || name.startsWith("args") ? () => 0 : stop) }),
  });
  instance.exports._initialize?.();
  return new Kernel(instance.exports);
}

/** The module's functions with arrays and texts of JavaScript. */
class Kernel {
  constructor(made) {
    this.made = made;
    this.message = made.malloc(MESSAGE);
  }

  /** Room for doubles, given back by `free`. */
  room(count) {
    const at = this.made.malloc(8 * Math.max(1, count));
    if (!at) throw new Error("there is no more memory for the kernel");
    return at;
  }

  free(at) {
    this.made.free(at);
  }

  /** Doubles that stand in the module's memory; they are seen until it grows. */
  doubles(at, count) {
    return new Float64Array(this.made.memory.buffer, at, count);
  }

  bytes(at, count) {
    return new Uint8Array(this.made.memory.buffer, at, count);
  }

  #said() {
    const bytes = this.bytes(this.message, MESSAGE);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  #needs(status) {
    if (status !== 0) throw new Error(this.#said() || "the kernel refuses");
  }

  #read(create, text) {
    const bytes = new TextEncoder().encode(text);
    const at = this.made.malloc(bytes.length + 4);
    this.bytes(at + 4, bytes.length).set(bytes);
    const status = create(at + 4, bytes.length, at, this.message);
    const made = new Uint32Array(this.made.memory.buffer, at, 1)[0];
    this.free(at);
    this.#needs(status);
    return made;
  }

  /** A plan with what its variants have in common. */
  plan(text) {
    return this.#read(this.made.mechkin_plan_create, text);
  }

  tape(text) {
    return this.#read(this.made.mechkin_tape_create, text);
  }

  sizes(plan) {
    const at = this.room(4);
    this.made.mechkin_page_sizes(plan, at);
    const [inputs, values, parameters, rows] = this.doubles(at, 4);
    this.free(at);
    return { inputs, values, parameters, rows };
  }

  runVariant(plan, parameters, rows, told) {
    this.#needs(this.made.mechkin_page_run(plan, parameters, rows, told, this.message));
  }

  runTape(tape, count, inputs, outputs) {
    this.#needs(this.made.mechkin_tape_run(tape, count, inputs, outputs, 0, this.message));
  }

  /** The texts of a column's cells. */
  texts(values, notation, digits) {
    const from = this.room(values.length);
    this.doubles(from, values.length).set(values);
    const write = (at, room) => this.made.mechkin_cell_texts(from, values.length, NOTATIONS[notation], digits, at, room);
    const room = 26 * values.length + 1024;
    let at = this.made.malloc(room);
    let size = write(at, room);
    if (size > room) {
      this.free(at);
      at = this.made.malloc(size);
      size = write(at, size);
    }
    const text = new TextDecoder().decode(this.bytes(at, size));
    this.free(at);
    this.free(from);
    return text.split("\n").slice(0, values.length);
  }
}

/** Computes what a file's sweep gives with changed parameters. */
export class LiveRun {
  #kernel;
  #rows; // where the run writes: values, residual, condition, power error
  #places = {};

  /** @param data  of the page, with its `live` record */
  constructor(kernel, data) {
    const { live } = data;
    this.data = data;
    this.live = live;
    this.parameters = live.parameters;
    this.fixed = live.fixed;
    this.left = live.left;
    this.endsEarly = false;
    this.#kernel = kernel;
    this.plan = kernel.plan(live.plan);
    this.sizes = kernel.sizes(this.plan);
    this.count = live.rows;
    this.tapes = { numbers: kernel.tape(live.numbers), cells: kernel.tape(live.cells) };
    const { made } = kernel;
    const outputs = (tape) => made.mechkin_tape_outputs(tape);
    this.numberCount = outputs(this.tapes.numbers);
    this.cellCount = outputs(this.tapes.cells);
    this.#places = {
      parameters: kernel.room(this.parameters.length),
      numbers: kernel.room(this.numberCount),
      told: kernel.room(5 + 2 * this.sizes.inputs),
      sources: kernel.room(Math.max(1, live.sources.length) * this.count),
      cells: kernel.room(this.cellCount * this.count),
    };
    this.#rows = kernel.room((this.sizes.values + 3) * this.count);
    this.tables = new LiveTables(this, data);
  }

  /** Values as they are in the file's units, in SI. */
  #inSi(values) {
    return this.parameters.map(({ name, value, si, factor: [multiplier, divisor] }) => {
      const given = values[name] ?? value;
      if (given === value) return si;
      if (divisor !== 1) return given / divisor;
      return multiplier !== 1 ? given * multiplier : given;
    });
  }

  /**
   * What the sweep gives with some parameters (by name, in the file's units; others as in the file).
   * @returns {{end, words, milliseconds, branch, tables}}  branch and tables as in the page's data, not there where no row
   *   is; texts of a table are made when they are first read
   */
  compute(values) {
    const start = performance.now();
    const found = this.#found(values);
    found.milliseconds = performance.now() - start;
    return found;
  }

  /** The kernel's run of the last parameters alone, for measurements. */
  runAlone() {
    this.#kernel.runVariant(this.plan, this.#places.parameters, this.#rows, this.#places.told);
  }

  #found(values) {
    const kernel = this.#kernel;
    const at = this.#places;
    const given = this.#inSi(values);
    if (given.some((value) => !Number.isFinite(value))) return { end: "lost", words: "a value is no finite number" };
    kernel.doubles(at.parameters, given.length).set(given);
    try {
      kernel.runVariant(this.plan, at.parameters, this.#rows, at.told);
      const told = [...kernel.doubles(at.told, 5 + 2 * this.sizes.inputs)];
      const end = ENDS[told[0]];
      const [first, last] = [told[1], told[2]];
      const words = this.#words(end, told);
      this.stopped = told[3] === 1 || told[4] === 1;
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

  /** The inputs of the cells: columns of the run, and what is given. */
  #gather() {
    const kernel = this.#kernel;
    const { count, sizes } = this;
    const from = kernel.doubles(this.#rows, (sizes.values + 3) * count);
    const to = kernel.doubles(this.#places.sources, Math.max(1, this.live.sources.length) * count);
    this.live.sources.forEach(([kind, k], place) => {
      const column = to.subarray(place * count, (place + 1) * count);
      if (kind === "slot") column.set(from.subarray(k * count, (k + 1) * count));
      else if (kind === "measure") column.set(from.subarray((sizes.values + k) * count, (sizes.values + k + 1) * count));
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
    return this.#kernel.doubles(this.#rows + 8 * k * this.count, this.count);
  }

  /** Residual, condition and power error; what the command does not compute is nothing. */
  measure(k) {
    const told = [true, this.live.verdict.loops, this.live.verdict.power][k];
    return told ? this.slot(this.sizes.values + k) : new Float64Array(this.count).fill(NaN);
  }

  cell(k) {
    return this.#kernel.doubles(this.#places.cells + 8 * k * this.count, this.count);
  }

  texts(values, notation, digits) {
    return this.#kernel.texts(values, notation, digits);
  }

  #result(end, words, first, last) {
    const judged = this.tables.verdicts(first, last, this.stopped ? "beyond-dead-centre" : "branch-lost");
    if (end === "complete" && judged.doubtful) {
      return { end: "incomplete", words: "a row stands next to a dead centre: the command looks at it more closely" };
    }
    const own = this.data.runs[0].branches[0];
    const made = this.tables.made(judged.codes, first, last);
    const axis = this.live.axis === null ? own.x : made.given(this.live.axis);
    const branch = {
      rows: this.count, x: axis, poses: posesOf(this, first, last), status: { ...own.status, codes: judged.codes }, marks: [],
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
