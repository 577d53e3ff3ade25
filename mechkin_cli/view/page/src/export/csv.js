// A table as the CSV file that `mechkin analyze` writes: all digits of its numbers, in the same notation.

import { countOf, exactColumns, rowOf } from "../panels/tables.js";

/** The text of a table's rows as the page has them; `own` is the branch that they are of. */
export function csvOf(table, own) {
  const exact = exactColumns(table, own);
  const lines = [table.columns.map(({ label }) => quoted(guarded(label))).join(",")];
  for (let at = 0; at < countOf(table); at += 1) {
    const texts = rowOf(table, at);
    const line = exact.map((values, k) => (values.length > 0 ? numberText(values[at], texts[k]) : quoted(guarded(texts[k])))).join(",");
    lines.push(line === "" ? '""' : line); // many readers skip blank lines
  }
  return `${lines.join("\n")}\n`;
}

/** The shortest digits that give the number back, plain from 1e-5 to 1e16; empty where there is none. */
export function numberText(value, infinite = "") {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "" : infinite;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-5 && size < 1e16) return plain(value);
  const [digits, exponent] = value.toExponential().split("e");
  const [sign, power] = [exponent[0], exponent.slice(1)];
  return `${digits}e${sign}${power.padStart(2, "0")}`;
}

/** This language writes 0.00001 as 1e-5. */
function plain(value) {
  const text = String(value);
  if (!text.includes("e")) return text;
  const [digits, exponent] = text.split("e");
  const [whole, part = ""] = digits.replace("-", "").split(".");
  return `${value < 0 ? "-" : ""}0.${"0".repeat(-Number(exponent) - 1)}${whole}${part}`;
}

/** With an apostrophe where a spreadsheet would find a formula. */
const guarded = (text) => text.replaceAll(/(^|[;\t\r\n])(?=[\s'"]*[=+\-@＝＋－＠])|^(?=[\t\r\n])/g, (found) => `${found}'`);

const quoted = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
