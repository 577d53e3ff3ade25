// What was set, step by step, to go back and on again.

const MOST = 500; // steps

/** A line of states and where in it we are. */
export class History {
  constructor(first) {
    this.states = [first];
    this.at = 0;
  }

  get canUndo() {
    return this.at > 0;
  }

  get canRedo() {
    return this.at < this.states.length - 1;
  }

  /** Adds a state after the present one, unless it is the same; what had been undone is forgotten. */
  add(state) {
    if (same(state, this.states[this.at])) return false;
    this.states = [...this.states.slice(0, this.at + 1), state].slice(-MOST);
    this.at = this.states.length - 1;
    return true;
  }

  /** The state one step back (-1) or on (1); null where there is none. */
  step(by) {
    const found = this.states[this.at + by];
    if (found === undefined) return null;
    this.at += by;
    return found;
  }
}

/** Whether two sets of values by name are the same. */
export const same = (one, other) => Object.keys(one).every((name) => one[name] === other[name]);
