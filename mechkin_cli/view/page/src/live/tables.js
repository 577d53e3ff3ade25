// Tables and verdicts of a sweep with changed parameters: the cells that the command writes.

const SIGNIFICANT = 6;
const [LEAST_PLAIN, MOST_PLAIN] = [-6, 9]; // exponents of a column without exponents, the last one not
const MEASURES = { residual: 0, condition: 1, power_error: 2, energy_error: 5 };

/** Makes tables of what the kernel found. */
export class LiveTables {
  /** @param tables  of the page's data */
  constructor(run, tables) {
    this.run = run;
    this.live = run.live;
    this.bases = new Map(tables.filter((table) => table.run === run.live.run).map((table) => [table.name, table]));
  }

  /** The codes of the rows' verdicts, those `missing` before and behind the others too; whether one is to be looked at more closely. */
  verdicts(first, last, missing) {
    const { run, live: { verdict } } = this;
    const codes = new Uint8Array(run.shownRows);
    const [before, behind] = missing.map((word) => verdict.words.indexOf(word));
    codes.fill(before, 0, first).fill(behind, last);
    let doubtful = false;
    const each = (columns, judge) => {
      for (let row = first; row < last; row += 1) judge(row, columns);
    };
    if (verdict.loops) {
      each(run.measure(1), (row, condition) => {
        for (const [limit, status] of verdict.condition) if (!(condition[row] <= limit)) codes[row] = status;
        doubtful ||= !(condition[row] <= verdict.clear);
      });
    }
    for (const { cell, limit, both, status } of verdict.cables) {
      const most = run.numbers[limit];
      each(run.cell(cell), (row, values) => {
        const beyond = values[row] < -most || (both && values[row] > most);
        if (beyond && codes[row] === 0) codes[row] = status;
      });
    }
    for (const slot of verdict.friction) each(run.slot(slot), (row, state) => state[row] !== 0 && (codes[row] = verdict.undecided));
    const [level, ...strands] = verdict.strands.map((slot) => run.slot(slot));
    const [share, slack] = verdict.slack;
    for (const strand of strands) each(strand, (row) => codes[row] === 0 && strand[row] < -share * level[row] && (codes[row] = slack));
    for (const { cell, ends, slack: room } of verdict.limits) {
      const [low, high] = ends.map((end, side) => (end === null ? (side ? Infinity : -Infinity) : run.numbers[end]));
      each(run.cell(cell), (row, values) => {
        const beyond = values[row] - high > room || values[row] - low < -room;
        if (beyond && verdict.forces[codes[row]]) codes[row] = verdict.beyond;
      });
    }
    return { codes, doubtful };
  }

  /** Tables and curves of the rows from `first` to before `last`; texts are made where they are read. */
  made(codes, first, last) {
    const { run, live } = this;
    const keep = (column) => {
      const kept = new Float64Array(run.shownRows).fill(NaN);
      for (let row = first; row < last; row += 1) if (Number.isFinite(column[row])) kept[row] = column[row];
      return kept;
    };
    const given = (k) => Float64Array.from(run.given(k).subarray(0, run.shownRows));
    const curves = new Map(); // values and rounding by table and label
    // of this run: texts are made when others were run
    const [unitSizes, events] = [run.unitSizes(first, last), run.events()];
    const tables = live.tables.map(({ name, columns, sizes: left }) => {
      const sizes = { ...unitSizes };
      for (const [unit, size] of Object.entries(left)) sizes[unit] = Math.max(sizes[unit] ?? 0, size);
      const made = columns.map((column) => {
        if (column === null || column.words) return { column, events };
        const values = column.given === undefined ? keep(run.cell(column.cell)) : column.every_row ? given(column.given) : keep(run.given(column.given));
        if (column.first) run.withFirst(values, column.first);
        if (column.unit) sizes[column.unit] = Math.max(sizes[column.unit] ?? 0, largestOf(values));
        return { column, values };
      });
      for (const one of made) {
        if (!one.values) continue;
        one.rounding = one.column.rounded ? live.zero * (sizes[one.column.unit] ?? 0) : 0;
        curves.set(`${name}\n${one.column.label}`, one);
      }
      return this.#table(this.bases.get(name), codes, made);
    });
    const inputs = new Map(live.row_inputs);
    const rows = live.response?.table ?? "rows";
    const measured = (this.bases.get(rows)?.columns ?? []).map(({ label }) => {
      const column = { decimals: label === "row" ? 0 : null, words: { status: "row.status", event: "row.event" }[label] ?? null };
      if (label in MEASURES) {
        const one = { column, values: keep(run.measure(MEASURES[label])), rounding: 0 };
        curves.set(`${rows}\n${label}`, one);
        return one;
      }
      if (inputs.has(label)) return { column, values: given(inputs.get(label)), rounding: 0 };
      const isLeft = live.left.some((one) => one.table === rows && one.label === label);
      return { column: isLeft ? null : { words: column.words ?? label }, events };
    });
    if (this.bases.has(rows)) tables.push(this.#table(this.bases.get(rows), codes, measured));
    const columns = (own) => own.flatMap((column) => {
      const found = curves.get(`${column.table}\n${column.label}`);
      return found ? [{ ...column, values: found.values, rounding: found.rounding }] : [];
    });
    return { tables, columns, given };
  }

  /** A table as the page's data have it. */
  #table(base, codes, made) {
    const texts = (one, k) => {
      const { column, values, rounding } = one;
      if (column === null) return new Array(codes.length).fill("");
      if (column.words === "row.status") return Array.from(codes, (code) => this.live.verdict.words[code]);
      if (column.words === "row.event") return one.events;
      if (column.words === "row") return Array.from(codes, (_, row) => `${row + 1}`);
      if (column.words) return new Array(codes.length).fill(base.rows[0]?.[k] ?? ""); // the same in all rows
      return this.#cellTexts(values, column.decimals, rounding);
    };
    const whyLeft = (label) => this.live.left.find((one) => one.table === base.name && one.label === label)?.why;
    let rows = null;
    return {
      ...base,
      columns: base.columns.map((head, k) => {
        if (made[k].column === null) return { ...head, exact: null, why: whyLeft(head.label) };
        return { ...head, exact: head.exact && made[k].values ? made[k].values : head.exact };
      }),
      status: Array.from(codes),
      get rows() {
        if (!rows) {
          const columns = made.map(texts);
          rows = Array.from(codes, (_, row) => columns.map((column) => column[row]));
        }
        return rows;
      },
    };
  }

  /** Texts of numbers, with so many decimals, or (null) six significant digits of the largest. */
  #cellTexts(values, decimals, rounding) {
    const { run } = this;
    if (decimals !== null) return run.texts(values, "fixed", decimals);
    const rounded = values.map((value) => (Math.abs(value) <= rounding ? 0 : value));
    const exponent = Number(largestOf(rounded).toExponential(SIGNIFICANT - 1).split("e")[1]);
    if (exponent < LEAST_PLAIN || exponent >= MOST_PLAIN) return run.texts(rounded, "scientific", SIGNIFICANT - 1);
    return run.texts(rounded, "trimmed", Math.max(0, SIGNIFICANT - 1 - exponent));
  }
}

function largestOf(values) {
  let largest = 0;
  for (const value of values) if (Math.abs(value) > largest && value - value === 0) largest = Math.abs(value);
  return largest;
}
