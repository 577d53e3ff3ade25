// The kernel that computes in the page: WebAssembly made of the sources that the command is made of (kernel/wasm).

const MESSAGE = 256;
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

  /** Runs a response: its columns, and end, rows, rows reached, stop, time, energy, moments reached in `told`. */
  respond(start, motion, parameters, rows, told) {
    this.#needs(this.made.mechkin_page_respond(start, motion, parameters, rows, told, this.message));
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
