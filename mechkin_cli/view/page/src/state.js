// What is shown now: run, branch, row. Everything that draws listens, and only here is it changed.

import { Branch } from "./branch.js";

/** The run, branch and row that are shown; `change` events say what became different. */
export class State extends EventTarget {
  #branches = new Map();
  #changed = new Map(); // by run: branches with changed dimensions, by their names

  constructor(data) {
    super();
    this.data = data;
    this.drawn = data; // with changed dimensions, what is drawn of them
    this.run = data.runs[0] ?? null;
    this.place = 0; // a row, or between two of them while it plays
    this.compare = false;
    this.withOriginal = true;
    this.tables = data.tables;
    this.branch = this.run ? this.branches(this.run)[0] : null;
  }

  /** The decoded branches of a run; where dimensions are changed, those that follow are as they make them. */
  branches(run = this.run) {
    const found = this.fileBranches(run);
    const changed = this.#changed.get(run);
    return changed ? found.map((each) => changed.get(each.name) ?? each) : found;
  }

  /** The branches of a run with the file's dimensions. */
  fileBranches(run = this.run) {
    if (!this.#branches.has(run)) {
      const made = run.branches.map((each) => new Branch(each, this.data.links.length));
      this.#branches.set(run, made);
    }
    return this.#branches.get(run);
  }

  /** The branch of the file's dimensions that the shown one was made of by changing them; null where nothing is changed. */
  get original() {
    return this.#isChanged(this.branch) ? this.fileBranches().find(({ name }) => name === this.branch.name) : null;
  }

  #isChanged(branch) {
    return branch !== null && this.#changed.get(this.run)?.get(branch.name) === branch;
  }

  /** The original where it is to be seen beside the changed one. */
  get shownOriginal() {
    return this.withOriginal ? this.original : null;
  }

  /** What is drawn of a branch: with changed dimensions, or with the file's. */
  drawnOf(branch) {
    return this.#isChanged(branch) ? this.drawn : this.data;
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

  /** Whether the original is seen beside the changed dimensions. */
  setWithOriginal(on) {
    this.withOriginal = on;
    this.#tell("compare");
  }

  /**
   * Shows changed dimensions; null: those of the file again.
   * @param changed  {runs: {name: {branch, tables}}, modes: {run: {name: branch}}, drawn}: packed as in the data, `drawn` the
   *   parts of these that differ; branches of other assembly modes stand in `modes`
   */
  setChanged(changed) {
    const { name: shown } = this.branch;
    const had = this.original !== null;
    this.#changed.clear();
    this.tables = this.data.tables;
    this.drawn = changed ? { ...this.data, ...changed.drawn } : this.data;
    for (const [name, { branch, tables }] of Object.entries(changed?.runs ?? {})) {
      const run = this.data.runs.find((each) => each.name === name);
      const own = this.fileBranches(run);
      const made = (of, packed) => new Branch({ ...of.packed, ...packed, name: of.name, own: of.own }, this.data.links.length);
      const others = own.flatMap((of) => (changed.modes?.[name]?.[of.name] ? [[of.name, made(of, changed.modes[name][of.name])]] : []));
      this.#changed.set(run, new Map([[own[0].name, made(own[0], branch)], ...others]));
      const ofRun = new Map((tables ?? []).map((table) => [table.name, table]));
      this.tables = this.tables.map((table) => (table.run === name ? (ofRun.get(table.name) ?? table) : table));
    }
    this.branch = this.branches().find(({ name }) => name === shown);
    this.place = Math.min(this.place, Math.max(0, this.branch.rows - 1));
    this.#tell("dimensions", ...(had === (this.original !== null) ? [] : ["compare"]));
  }

  /** Calls `listener(changes)` now and on each change. */
  watch(listener) {
    this.addEventListener("change", (event) => listener(event.detail));
    listener(new Set(["run", "branch", "row", "compare"]));
  }
}
