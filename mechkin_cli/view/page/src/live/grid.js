// The values that a slider can take: round numbers between two ends, and the file's own value, which is one of them.

const STEPS = 400; // about so many in a slider

/** Round numbers from `low` to `high`. */
export class Grid {
  /** @param parameter  {value, low, high, integer}: the file's value and the ends of the slider */
  constructor({ value, low, high, integer }) {
    this.own = value;
    const [least, most] = [Math.min(low, value), Math.max(high, value)];
    const span = most - least || Math.abs(value) || 1;
    const fine = roundStep(span / STEPS);
    this.step = integer ? Math.max(1, Math.round(fine)) : fine;
    // a little room, so that an end that is a round number is one of them in spite of rounding
    this.first = Math.min(Math.ceil(least / this.step - 1e-9), this.indexOf(value));
    this.last = Math.max(Math.floor(most / this.step + 1e-9), this.indexOf(value));
  }

  /** The place of the nearest round number, counted from zero. */
  indexOf(value) {
    return Math.round(value / this.step);
  }

  /** The value at a place; the file's own where that is the nearest. */
  at(index) {
    if (index === this.indexOf(this.own)) return this.own;
    return Number((index * this.step).toPrecision(12));
  }

  /** The nearest value of the grid. */
  snap(value) {
    return this.at(this.indexOf(value));
  }

  /** Where a value lies between the ends, 0 to 1. */
  share(value) {
    const share = (value / this.step - this.first) / Math.max(1, this.last - this.first);
    return Math.min(1, Math.max(0, share));
  }
}

/** The largest of 1, 2, 5 times a power of ten that is not above a number. */
function roundStep(wished) {
  const power = 10 ** Math.floor(Math.log10(wished));
  const factor = [5, 2].find((each) => each * power <= wished * (1 + 1e-12)) ?? 1;
  return Number((factor * power).toPrecision(3));
}
