// What is shown now: run, branch, row. Everything that draws listens, and only here is it changed.

import { Branch } from "./branch.js";

/** The run, branch and row that are shown; `change` events say what became different. */
export class State extends EventTarget {
  #branches = new Map();

  constructor(data) {
    super();
    this.data = data;
    this.run = data.runs[0] ?? null;
    this.place = 0; // a row, or between two of them while it plays
    this.compare = false;
    this.branch = this.run ? this.branches(this.run)[0] : null;
  }

  /** The decoded branches of a run. */
  branches(run = this.run) {
    if (!this.#branches.has(run)) {
      const made = run.branches.map((each) => new Branch(each, this.data.links.length));
      this.#branches.set(run, made);
    }
    return this.#branches.get(run);
  }

  /** The row that is shown. */
  get row() {
    return Math.round(this.place);
  }

  #tell(...what) {
    this.dispatchEvent(new CustomEvent("change", { detail: new Set(what) }));
  }

  /** Shows a row; a place between two rows is told of by `between`. */
  seek(place) {
    const last = Math.max(0, (this.branch?.rows ?? 1) - 1);
    const kept = Math.min(last, Math.max(0, place));
    if (!Number.isFinite(kept) || kept === this.place) return;
    this.place = kept;
    this.#tell("row");
  }

  setRun(name) {
    const run = this.data.runs.find((each) => each.name === name);
    if (!run || run === this.run) return;
    this.run = run;
    this.branch = this.branches(run)[0];
    this.place = 0;
    this.#tell("run", "branch", "row");
  }

  /** Shows another assembly mode at the place nearest to the one that was shown. */
  setBranch(name) {
    const branch = this.branches().find((each) => each.name === name);
    if (!branch || branch === this.branch) return;
    const x = this.branch.x[this.row];
    const same = branch.rows === this.branch.rows && branch.x[this.row] === x;
    this.place = same ? this.row : branch.rowAt(x);
    this.branch = branch;
    this.#tell("branch", "row");
  }

  nextBranch() {
    const all = this.branches();
    this.setBranch(all[(all.indexOf(this.branch) + 1) % all.length].name);
  }

  setCompare(compare) {
    this.compare = compare;
    this.#tell("compare");
  }

  /** Calls `listener(changes)` now and on each change. */
  watch(listener) {
    this.addEventListener("change", (event) => listener(event.detail));
    listener(new Set(["run", "branch", "row", "compare"]));
  }
}
