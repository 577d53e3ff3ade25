// Tables and verdicts of a sweep with changed parameters: the cells that the command writes.

import { numbers } from "../data.js";

const SIGNIFICANT = 6;
const [LEAST_PLAIN, MOST_PLAIN] = [-6, 9]; // exponents of a column without exponents, the last one not

/** Makes tables of what the kernel found. */
export class LiveTables {
  constructor(run, data) {
    this.run = run;
    this.live = run.live;
    this.data = data;
  }

  /** The codes of the rows' verdicts, and whether one is to be looked at more closely. */
  verdicts(first, last) {
    const { run, live: { verdict } } = this;
    const codes = new Uint8Array(run.count);
    const condition = run.measure(1);
    let doubtful = false;
    for (let row = first; row < last; row += 1) {
      let code = 0;
      if (verdict.loops) {
        for (const [limit, status] of verdict.condition) if (!(condition[row] <= limit)) code = status;
        doubtful ||= !(condition[row] <= verdict.clear);
      }
      for (const slot of verdict.friction) if (run.slot(slot)[row] !== 0) code = verdict.undecided;
      for (const slot of verdict.strands.slice(1)) {
        const level = run.slot(verdict.strands[0])[row];
        if (code === 0 && run.slot(slot)[row] < -verdict.slack[0] * level) [, code] = verdict.slack;
      }
      for (const { cell, ends: [low, high], slack } of verdict.limits) {
        const value = run.cell(cell)[row];
        const under = low !== null && value - run.numbers[low] < -slack;
        const over = high !== null && value - run.numbers[high] > slack;
        if ((under || over) && verdict.forces[code]) code = verdict.beyond;
      }
      codes[row] = code;
    }
    const lost = verdict.words.indexOf("branch-lost");
    for (let row = 0; row < run.count; row += 1) if (row < first || row >= last) codes[row] = lost;
    return { codes, doubtful };
  }

  /** Tables and curves of the rows from `first` to before `last`. */
  made(codes, first, last) {
    const { run, live } = this;
    const keep = (column) => {
      const kept = Float64Array.from(column);
      for (let row = 0; row < kept.length; row += 1) if (row < first || row >= last || !Number.isFinite(kept[row])) kept[row] = NaN;
      return kept;
    };
    const given = (k) => Float64Array.from(run.given(k));
    const values = new Map(); // by table and label
    const roundings = new Map();
    const tables = [];
    for (const { name, columns } of live.tables) {
      const base = this.data.tables.find((table) => table.run === live.run && table.name === name);
      const found = columns.map((column) => {
        if (column === null || column.words) return null;
        return column.given !== undefined ? given(column.given) : keep(run.cell(column.cell));
      });
      const sizes = { ...live.sizes };
      found.forEach((column, k) => {
        const unit = columns[k]?.unit;
        if (column && unit) sizes[unit] = Math.max(sizes[unit] ?? 0, largestOf(column));
      });
      const texts = found.map((column, k) => this.#texts(columns[k], column, base, k, codes, sizes));
      found.forEach((column, k) => {
        if (!column) return;
        const key = `${name}\n${columns[k].label}`;
        values.set(key, column);
        roundings.set(key, roundingOf(columns[k], sizes, live.zero));
      });
      const rows = Array.from({ length: run.count }, (_, row) => texts.map((column) => column[row]));
      const heads = base.columns.map((head, k) => ({ ...head, exact: columns[k] === null ? null : (head.exact && found[k]) ?? head.exact }));
      tables.push({ ...base, columns: heads, rows, status: [...codes] });
    }
    const measures = { residual: 0, condition: 1, power_error: 2 };
    for (const [label, k] of Object.entries(measures)) values.set(`rows\n${label}`, keep(run.measure(k)));
    tables.push(this.#rowsTable(codes, keep));
    const columns = (own) => own.flatMap((column) => {
      const found = values.get(`${column.table}\n${column.label}`);
      return found ? [{ ...column, values: found, rounding: roundings.get(`${column.table}\n${column.label}`) ?? column.rounding }] : [];
    });
    return { tables, columns, given, peaks: null };
  }

  #texts(column, found, base, k, codes, sizes) {
    const { run, live } = this;
    if (column === null) return new Array(run.count).fill("");
    if (column.words === "row.status") return [...codes].map((code) => live.verdict.words[code]);
    if (column.words) return base.rows.map((row) => row[k]);
    return this.cellTexts(found, column.decimals, roundingOf(column, sizes, live.zero));
  }

  /** Texts of numbers, with so many decimals, or (null) six significant digits of the largest. */
  cellTexts(values, decimals, rounding) {
    const { run } = this;
    if (decimals !== null) return run.texts(values, "fixed", decimals);
    const rounded = values.map((value) => (Math.abs(value) <= rounding ? 0 : value));
    const exponent = Number(largestOf(rounded).toExponential(SIGNIFICANT - 1).split("e")[1]);
    if (exponent < LEAST_PLAIN || exponent >= MOST_PLAIN) return run.texts(rounded, "scientific", SIGNIFICANT - 1);
    return run.texts(rounded, "trimmed", Math.max(0, SIGNIFICANT - 1 - exponent));
  }

  /** The table of the rows and their verdicts. */
  #rowsTable(codes, keep) {
    const { run, live } = this;
    const base = this.data.tables.find((table) => table.run === live.run && table.name === "rows");
    const measures = { residual: 0, condition: 1, power_error: 2 };
    const inputs = new Map(live.row_inputs.map(([name, k]) => [name, k]));
    const texts = base.columns.map(({ label }, k) => {
      if (label in measures) return this.cellTexts(keep(run.measure(measures[label])), null, 0);
      if (label === "status") return [...codes].map((code) => live.verdict.words[code]);
      if (inputs.has(label)) return this.cellTexts(Float64Array.from(run.given(inputs.get(label))), null, 0);
      return base.rows.map((row) => row[k]);
    });
    const exact = (label, own) => (own && label in measures ? keep(run.measure(measures[label])) : own && inputs.has(label) ? Float64Array.from(run.given(inputs.get(label))) : own);
    return {
      ...base,
      columns: base.columns.map((head) => ({ ...head, exact: exact(head.label, head.exact) })),
      rows: Array.from({ length: run.count }, (_, row) => texts.map((column) => column[row])),
      status: [...codes],
    };
  }
}

function largestOf(values) {
  let largest = 0;
  for (const value of values) if (Number.isFinite(value) && Math.abs(value) > largest) largest = Math.abs(value);
  return largest;
}

const roundingOf = ({ rounded, unit }, sizes, zero) => (rounded ? zero * (sizes[unit] ?? 0) : 0);

/** The numbers of a column as the page's data have it, packed or not. */
export const unpacked = (values) => (ArrayBuffer.isView(values) ? values : numbers(values));
