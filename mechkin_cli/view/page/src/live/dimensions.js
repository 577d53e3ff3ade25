// The dimensions as they are set now: one computation for each picture, what it gave shown, and how far each can go.

import { Grid } from "./grid.js";
import { History, same } from "./history.js";

const PICTURE = 16; // milliseconds: nothing may hold the page up for longer while something is dragged
const SEARCH = 8; // milliseconds of a picture for the search of an end
const IDLE = 250; // milliseconds without a change, after which the ends of all sliders are looked for
const MOST_SEARCH = 3000; // milliseconds of that after one change

/**
 * Values of the parameters that can be changed. Events: `change` when other ones are shown, `settle` when a change is
 * finished, `ends` when more is known of where the mechanism no longer assembles, `words` when there is something to say.
 */
export class Dimensions extends EventTarget {
  #wanted;
  #finish = false;
  #asked = false;
  #notBefore = 0;
  #search = null;
  #approached = null;
  #timer = 0;

  /**
   * @param run  computes: `parameters` and `compute(values)`
   * @param show  takes what was computed, or null for the file's own
   */
  constructor(run, show) {
    super();
    this.run = run;
    this.show = show;
    this.parameters = run.parameters;
    this.own = Object.fromEntries(run.parameters.map(({ name, value }) => [name, value]));
    this.grids = new Map(run.parameters.map((each) => [each.name, new Grid(each)]));
    this.values = this.own; // those that are shown
    this.#wanted = this.own;
    this.history = new History(this.own);
    this.ends = new Map(); // by name: {low, high}, the last values that assemble, where a slider reaches beyond
    this.words = "";
    this.milliseconds = 0;
    this.cost = 0; // milliseconds that a change takes with all that follows it
  }

  get changed() {
    return !same(this.values, this.own);
  }

  isChanged(name) {
    return this.values[name] !== this.own[name];
  }

  /** Sets one parameter; `finished`: nothing is being dragged, so that the change can be undone as one. */
  set(name, value, finished = true) {
    if (!(name in this.own) || !Number.isFinite(value)) return;
    const { low = -Infinity, high = Infinity } = this.ends.get(name) ?? {};
    const kept = Math.min(high, Math.max(low, value));
    if (kept !== value) this.#say(this.#endWords(name, kept < value ? "high" : "low"));
    this.setAll({ [name]: kept }, finished);
  }

  /** Sets several parameters at once; the others stay. */
  setAll(values, finished = true) {
    const known = Object.entries(values).filter(([name, value]) => name in this.own && Number.isFinite(value));
    this.#wanted = { ...this.#wanted, ...Object.fromEntries(known) };
    this.#finish ||= finished;
    this.#search = null;
    this.#ask();
  }

  /** Computes what is shown once more, as something else of it is looked at. */
  again() {
    const found = this.#compute(this.values);
    if (found) this.show(found);
  }

  reset(name) {
    this.setAll({ [name]: this.own[name] });
  }

  resetAll() {
    this.setAll(this.own);
  }

  undo() {
    this.#goTo(this.history.step(-1));
  }

  redo() {
    this.#goTo(this.history.step(1));
  }

  #goTo(values) {
    if (values) this.setAll(values);
  }

  /** Computes in the browser's next frame, however many changes come until then. */
  #ask() {
    clearTimeout(this.#timer);
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame((now) => {
      this.#asked = false;
      if (now < this.#notBefore && !this.#finish) this.#ask();
      else this.#step();
    });
  }

  #step() {
    const start = performance.now();
    const wanted = this.#wanted;
    if (!same(wanted, this.values)) {
      const found = this.#compute(wanted);
      if (found) this.#take(wanted, found);
      else this.#approach(wanted, start);
    }
    const spent = performance.now() - start;
    this.cost = this.cost === 0 ? spent : 0.7 * this.cost + 0.3 * spent;
    // what takes longer than a picture leaves as much time for others
    this.#notBefore = spent > PICTURE ? performance.now() + spent : 0;
    if (!same(this.#wanted, this.values)) this.#ask();
    else if (this.#finish) this.#settle();
  }

  /** What the values give; null, with words, where they cannot be. */
  #compute(values) {
    const found = this.run.compute(values);
    if (found.end === "complete" || (found.branch && this.run.endsEarly)) return found;
    this.reason = found.words || "with these dimensions the mechanism cannot be assembled";
    return null;
  }

  #take(values, found) {
    const changed = Object.keys(values).filter((name) => values[name] !== this.values[name]);
    // an end is where it is for the other parameters as they are
    for (const name of this.ends.keys()) if (changed.some((each) => each !== name)) this.ends.delete(name);
    this.values = values;
    this.milliseconds = found.milliseconds ?? 0;
    this.show(this.changed ? found : null);
    if (changed.some((name) => !this.#isAtEnd(name))) this.#say(found.end === "complete" ? "" : sentence(found.words));
    this.dispatchEvent(new Event("change"));
  }

  #isAtEnd(name) {
    const { low, high } = this.ends.get(name) ?? {};
    return this.values[name] === low || this.values[name] === high;
  }

  /** Between what is shown and what cannot be: the last value that assembles, as near as this picture has time for. */
  #approach(wanted, start) {
    const names = Object.keys(wanted).filter((name) => wanted[name] !== this.values[name]);
    if (names.length > 1) {
      this.#wanted = this.values;
      this.#say(`${sentence(this.reason)} The dimensions before it are shown.`);
      return;
    }
    const [name] = names;
    // what one picture has no time for goes on in the next one
    if (this.#approached?.wanted !== wanted) {
      this.#approached = { wanted, search: new EndSearch(this.grids.get(name), this.values[name], wanted[name]) };
    }
    const { search } = this.#approached;
    let found = null;
    while (!search.done && performance.now() - start < SEARCH) {
      const value = search.next;
      const good = this.#compute({ ...wanted, [name]: value });
      search.tell(good !== null);
      if (good) found = { value, good };
    }
    const reached = { ...wanted, [name]: search.good };
    if (search.done) {
      this.#keepEnd(name, search);
      this.#wanted = reached;
    }
    if (found && found.value === search.good) this.#take(reached, found.good);
    if (search.done) this.#say(this.#endWords(name, search.bad > search.good ? "high" : "low"));
  }

  #keepEnd(name, { good, bad }) {
    const side = bad > good ? "high" : "low";
    const known = this.ends.get(name) ?? {};
    this.ends.set(name, { ...known, [side]: good, why: { ...known.why, [side]: this.reason } });
    this.dispatchEvent(new Event("ends"));
  }

  #endWords(name, side) {
    const { unit } = this.parameters.find((each) => each.name === name);
    const end = this.ends.get(name);
    return `${name} can go no further than ${unit ? `${end[side]} ${unit}` : end[side]}. ${sentence(end.why[side])}`;
  }

  #say(words) {
    if (words === this.words) return;
    this.words = words;
    this.dispatchEvent(new Event("words"));
  }

  #settle() {
    this.#finish = false;
    this.history.add(this.values);
    this.dispatchEvent(new Event("settle"));
    this.lookForEnds();
  }

  /** Looks, while nothing else is done, for where the sliders' ways end. */
  lookForEnds() {
    clearTimeout(this.#timer);
    let spent = 0;
    const search = this.#allEnds();
    this.#search = search;
    const slice = () => {
      if (this.#search !== search) return;
      const start = performance.now();
      let done = false;
      while (!done && performance.now() - start < SEARCH) ({ done } = search.next());
      spent += performance.now() - start;
      if (!done && spent < MOST_SEARCH) this.#timer = setTimeout(slice, SEARCH);
      else this.#search = null;
    };
    this.#timer = setTimeout(slice, IDLE);
  }

  *#allEnds() {
    for (const { name } of this.parameters) {
      const grid = this.grids.get(name);
      for (const end of [grid.first, grid.last]) {
        const wanted = grid.at(end);
        const side = end === grid.first ? "low" : "high";
        if (this.ends.get(name)?.[side] !== undefined || wanted === this.values[name]) continue;
        const assembles = (value) => this.#compute({ ...this.values, [name]: value }) !== null;
        yield;
        if (assembles(wanted)) continue;
        const search = new EndSearch(grid, this.values[name], wanted);
        while (!search.done) {
          yield;
          search.tell(assembles(search.next));
        }
        this.#keepEnd(name, search);
      }
    }
  }
}

/** Halves the way from a value that assembles to one that does not, in values of a grid. */
class EndSearch {
  constructor(grid, good, bad) {
    Object.assign(this, { grid, good, bad });
  }

  get next() {
    return this.grid.snap((this.good + this.bad) / 2);
  }

  get done() {
    const value = this.next;
    return !((value - this.good) * (this.bad - value) > 0);
  }

  tell(assembles) {
    const value = this.next;
    if (assembles) this.good = value;
    else this.bad = value;
  }
}

/** With a capital and a full stop. */
function sentence(text) {
  const whole = text.trim();
  return `${whole.charAt(0).toUpperCase()}${whole.slice(1)}${/[.!?]$/.test(whole) ? "" : "."}`;
}
