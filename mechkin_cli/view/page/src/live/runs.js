// All runs of a page that it computes: the one that leads, and others that follow the same changes.

import { LiveResponse } from "./response.js";
import { LiveRun } from "./run.js";

const runOf = (kernel, data, live) => (live.response ? new LiveResponse(kernel, data, live) : new LiveRun(kernel, data, live));

/** The runs of the data's records, computed together. */
export class LiveRuns {
  constructor(kernel, data) {
    const { live } = data;
    this.leading = runOf(kernel, data, live);
    this.others = (live.others ?? []).map((record) => runOf(kernel, data, record));
    this.parameters = live.parameters;
    this.fixed = live.fixed;
    this.left = [this.leading, ...this.others].flatMap(({ left }) => left);
    this.shown = () => null; // {run, name} of the branch that is looked at
    this.endsEarly = live.ends_early; // rows without a solution are shown, as the file has such
  }

  /** The numbers that hang on the parameters, of the drawing. */
  get numbers() {
    return this.leading.numbers;
  }

  /** As `LiveRun.compute`, and in `runs` branch and tables of every run that follows these values, and in `modes` the
   *  branch of the assembly mode that is shown, where it is another one. */
  compute(values) {
    const start = performance.now();
    const found = this.leading.compute(values);
    found.runs = {};
    if (found.branch) {
      for (const run of [this.leading, ...this.others]) {
        const { end, branch, tables } = run === this.leading ? found : this.#other(run, values);
        if (branch && (run === this.leading || end === "complete" || run.live.ends_early)) found.runs[run.live.run] = { branch, tables };
      }
    }
    found.modes = found.branch ? this.#mode(values, this.shown()) : {};
    found.milliseconds = performance.now() - start;
    return found;
  }

  #mode(values, shown) {
    const run = [this.leading, ...this.others].find(({ live }) => live.run === shown?.run);
    if (!run?.follows(shown.name)) return {};
    const { branch } = run.compute(values, shown.name);
    return branch ? { [shown.run]: { [shown.name]: branch } } : {};
  }

  /** What another run gives; nothing where it does not follow what is changed. */
  #other(run, values) {
    const known = new Set(run.parameters.map(({ name }) => name));
    const changed = this.parameters.filter(({ name, value }) => (values[name] ?? value) !== value);
    return changed.every(({ name }) => known.has(name)) ? run.compute(values) : {};
  }

  /** The kernel's run of the last parameters alone, for measurements. */
  runAlone() {
    this.leading.runAlone();
  }
}
