// Numbers as people read them.

const ROUNDING = 1e-13; // of the largest of its column: less is zero

/** A number with as many digits as a reading needs; of a column whose `largest` is given, without its rounding. */
export function told(value, digits = 6, largest = 0) {
  if (!Number.isFinite(value)) return "none";
  if (Math.abs(value) < ROUNDING * largest) return "0";
  const text = value.toPrecision(digits);
  return text.includes("e") ? String(Number(text)) : String(Number(text)).replace("-", "\u2212");
}

const LEVEL = 1e-8; // of their size: so near to one another no labels of a scale tell two numbers apart

/** The ends of a range; twice the same number where they are too near to one another for a scale. */
export function levelled(low, high) {
  const isLevel = high - low <= LEVEL * Math.max(Math.abs(low), Math.abs(high));
  return isLevel ? [low, low] : [low, high];
}
