// Numbers as people read them.

/** A number with as many digits as a reading needs. */
export function told(value, digits = 6) {
  if (!Number.isFinite(value)) return "none";
  const text = value.toPrecision(digits);
  return text.includes("e") ? String(Number(text)) : String(Number(text)).replace("-", "\u2212");
}
