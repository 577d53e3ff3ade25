// Which columns are plotted: a list to search and tick, by table, with the value at the row that is shown.

import { element } from "../dom.js";

/** A list of columns; `onChange(keys)` hears of what is ticked. */
export class ColumnChoice {
  constructor(onChange) {
    this.onChange = onChange;
    this.list = element("div.columns");
    this.search = element("input", { type: "search", placeholder: "find a column", "aria-label": "Find a column", on: { input: () => this.#filter() } });
    this.count = element("span");
    this.more = element("details.choose", {}, element("summary", {}, "Columns ", this.count), this.search, this.list);
    this.now = element("div.now");
    this.node = element("div.choice", {}, this.now, this.more);
  }

  /** Offers columns {key, label, unit, table}, of which `keys` are ticked. */
  offer(columns, keys) {
    this.keys = keys;
    this.columns = columns;
    this.rows = [];
    this.list.replaceChildren();
    let table = null;
    for (const column of columns) {
      if (column.table !== table) {
        table = column.table;
        this.list.append(element("h4", {}, table ?? ""));
      }
      const box = element("input", { type: "checkbox", checked: keys.has(column.key) });
      box.addEventListener("change", () => this.#turn(column.key, box.checked));
      const row = element("label", {}, box, element("span", {}, column.label), element("small", {}, column.unit ?? ""));
      this.rows.push({ column, row });
      this.list.append(row);
    }
    this.#tellChosen();
  }

  #turn(key, on) {
    if (on) this.keys.add(key);
    else this.keys.delete(key);
    this.#tellChosen();
    this.onChange(this.keys);
  }

  #tellChosen() {
    this.count.textContent = `(${this.keys.size} of ${this.columns.length})`;
    this.chips = this.columns.filter(({ key }) => this.keys.has(key)).map((column) => {
      const value = element("b");
      const chip = element("span.chip", {}, `${column.label} `, value, column.unit ? ` ${column.unit}` : "");
      return { key: column.key, chip, value };
    });
    this.now.replaceChildren(...this.chips.map(({ chip }) => chip));
  }

  #filter() {
    const wanted = this.search.value.trim().toLowerCase();
    for (const { column, row } of this.rows) {
      row.hidden = wanted !== "" && !`${column.table} ${column.label}`.toLowerCase().includes(wanted);
    }
  }

  /** Gives the chips their curves' colours. */
  paint(colours) {
    for (const { key, chip } of this.chips) chip.style.setProperty("--curve", colours.get(key) ?? "transparent");
  }

  /** Writes the value of each chosen column. */
  tell(valueOf) {
    for (const { key, value } of this.chips) value.textContent = valueOf(key);
  }
}
