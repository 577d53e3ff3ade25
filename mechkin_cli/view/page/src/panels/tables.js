// Tables with verdicts. Only the rows that are seen are elements, so that 20 000 rows scroll as ten do.

import { numbers } from "../data.js";
import { choice, element } from "../dom.js";

const ROW = 26; // pixels; the style sheet has the same
const BEYOND = 10; // rows above and below what is seen
const ON_PAPER = 400; // rows of a table that are printed

/** The tables of all runs, one at a time. */
export class Tables {
  constructor(host, state, theme) {
    this.state = state;
    this.theme = theme;
    const { tables } = state.data;
    if (tables.length === 0) {
      host.append(element("p.empty", {}, "The file has no tables."));
      return;
    }
    const names = tables.map((table) => (table.title && table.title !== table.name ? `${table.name}: ${table.title}` : table.name));
    this.choice = choice("Table", names, (k) => this.#open(k));
    this.remark = element("p.remark");
    this.head = element("thead");
    this.body = element("tbody");
    this.scroller = element("div.scroller", { tabindex: "0", on: { scroll: () => this.#fill() } },
      element("table", {}, this.head, this.body));
    host.append(element("div.choice", {}, this.choice), this.remark, this.scroller);
    this.body.addEventListener("click", (event) => this.#click(event));
    new ResizeObserver(() => this.#unfold()).observe(this.scroller);
    theme.addEventListener("change", () => (this.stale ? this.#read() : this.#fill(true)));
    this.#open(0);
    state.watch((changes) => {
      // what is not seen is not read anew before it is
      if (changes.has("dimensions") && this.scroller.clientHeight === 0 && !theme.printing) this.stale = true;
      else if (changes.has("dimensions")) this.#read();
      this.#follow();
    });
  }

  /** The table that is open, as it is now. */
  get shown() {
    if (this.stale) this.#read();
    return this.table;
  }

  /** The run's row that a table's row shows, or -1. */
  #runRow(at) {
    return this.table.rowsOf ? this.table.rowsOf[at] : at;
  }

  #open(number) {
    this.number = number;
    this.scroller.scrollTop = 0;
    this.#read();
    this.#follow();
  }

  /** The table as it is now: dimensions may have changed. */
  #read() {
    this.stale = false;
    const table = this.state.tables[this.number];
    this.table = table;
    this.count = countOf(table);
    // a table without verdicts has other rows than its run
    const run = table.status?.length ? this.state.data.runs.find((each) => each.name === table.run) : undefined;
    this.run = run ?? null;
    this.own = run ? this.state.branches(run)[0] : null;
    this.exact = exactColumns(table, this.own);
    this.places = new Map();
    if (run) for (let at = 0; at < this.count; at += 1) this.places.set(this.#runRow(at), at);
    const cells = table.columns.map(({ label, unit, why }) =>
      element("th", { scope: "col", ...leftOut(why) }, element("span", {}, label), element("small", {}, unit ?? "")));
    this.head.replaceChildren(element("tr", {}, ...cells, ...(table.status?.length ? [element("th", { scope: "col" }, element("span", {}, "verdict"))] : [])));
    this.now = null;
    this.#fill(true);
  }

  /** Makes the rows that are seen now; on paper, all that fit a print. */
  #fill(anew = false) {
    if (!this.table) return;
    const { count } = this;
    const seen = Math.ceil((this.scroller.clientHeight || 400) / ROW);
    let from = Math.max(0, Math.floor(this.scroller.scrollTop / ROW) - BEYOND);
    let to = Math.min(count, from + seen + 2 * BEYOND);
    if (this.theme.printing) [from, to] = [0, Math.min(count, ON_PAPER)];
    if (!anew && from === this.from && to === this.to) return;
    [this.from, this.to] = [from, to];
    const rows = [];
    for (let at = from; at < to; at += 1) rows.push(this.#row(at));
    const width = this.table.columns.length + 1;
    const space = (height) => element("tr.space", { "aria-hidden": "true" }, element("td", { colspan: width, style: { height: `${height}px` } }));
    const left = this.theme.printing ? 0 : (count - to) * ROW;
    this.body.replaceChildren(space(from * ROW), ...rows, space(left));
    if (this.theme.printing && to < count) {
      this.body.append(element("tr", {}, element("td", { colspan: width }, `${count - to} more rows are in the table's file`)));
    }
    this.#mark();
  }

  #row(at) {
    const cells = rowOf(this.table, at).map((text, k) => {
      const { why } = this.table.columns[k];
      return element("td", why ? leftOut(why) : allDigits(this.exact[k]?.[at], text), text);
    });
    const row = element("tr", { data: { at } }, ...cells);
    const code = this.table.status?.[at];
    if (code !== undefined) {
      const word = this.own?.words[code] ?? "";
      row.append(element("td.verdict", { style: { "--verdict": this.own?.colour(code) } }, word));
      if (word !== "ok") row.classList.add("doubtful");
    }
    return row;
  }

  #click(event) {
    const at = event.target.closest("tr")?.dataset.at;
    if (at === undefined || !this.run) return;
    const row = this.#runRow(Number(at));
    if (row < 0) return;
    this.state.setRun(this.run.name);
    this.state.setBranch(this.own.name);
    this.state.seek(row);
  }

  /** Shows the row that the drawing shows, where the table has it. */
  #follow() {
    const mine = this.run === this.state.run;
    const here = mine && this.own === this.state.branch;
    this.remark.textContent = !this.run ? "" : !mine ? `of the run ${this.run.name}` : here ? "" : `of ${this.own.name}, the file's own`;
    const at = here ? this.places.get(this.state.row) : undefined;
    if (at === this.now) return;
    this.now = at;
    if (at !== undefined && this.scroller.clientHeight > 0) {
      const head = this.head.offsetHeight;
      const top = at * ROW;
      const { scrollTop, clientHeight } = this.scroller;
      if (top < scrollTop || top + ROW + head > scrollTop + clientHeight) {
        this.scroller.scrollTop = Math.max(0, top - clientHeight / 2 + head);
      }
      this.#fill();
    }
    this.#mark();
  }

  /** The panel is opened, or has another height: the row that is shown is brought into it. */
  #unfold() {
    if (this.stale) this.#read();
    this.now = null;
    this.#follow();
    this.#fill();
  }

  #mark() {
    for (const row of this.body.children) row.classList.toggle("here", row.dataset.at === String(this.now));
  }
}

/** How many rows a table has, and the texts of one: made when they are seen where dimensions are changed. */
export const countOf = (table) => table.count ?? table.rows.length;
export const rowOf = (table, at) => (table.row ? table.row(at) : table.rows[at]);

/** All digits of a table's columns; those that its branch has as curves are not repeated in it. */
export function exactColumns(table, own) {
  const curves = own?.columns.filter((each) => each.table === table.name) ?? [];
  return table.columns.map(({ exact, label }) => numbers(exact ?? curves.find((each) => each.label === label)?.values));
}

/** What a cell shows on hover: all digits of its number, where the text has fewer. */
function allDigits(number, text) {
  return Number.isFinite(number) && Number(text) !== number ? { title: String(number) } : {};
}

/** Why a column is empty with changed dimensions. */
function leftOut(why) {
  return why ? { title: `empty with changed dimensions: ${why}` } : {};
}
