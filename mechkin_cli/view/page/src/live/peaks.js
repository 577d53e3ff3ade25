// What became of the peaks: of every column its largest value with the file's dimensions and with the changed ones.

import { numbers } from "../data.js";
import { element } from "../dom.js";
import { told } from "../numbers.js";

/** A table of peaks, filled while it is seen. */
export class Peaks {
  constructor(host, state) {
    this.host = host;
    this.state = state;
    this.remark = element("p.remark");
    this.body = element("tbody");
    const heads = ["quantity", "original", "changed", "difference"].map((text) => element("th", { scope: "col" }, text));
    this.table = element("div.scroller.peaks", { tabindex: "0" }, element("table", {}, element("thead", {}, element("tr", {}, ...heads)), this.body));
    host.append(this.remark, this.table);
    new ResizeObserver(() => this.#show()).observe(host);
    state.watch((changes) => {
      if (["run", "branch", "dimensions"].some((each) => changes.has(each))) this.#show();
    });
  }

  #show() {
    if (this.host.clientHeight === 0) return;
    const { original, branch, run } = this.state;
    this.remark.textContent = original
      ? `Largest magnitude of each column over all rows of ${run.name}, with its sign.`
      : "Change a dimension, and here stand the peaks before and after.";
    this.body.replaceChildren(...(original ?? branch).columns.map((column) => {
      const changed = original && branch.columns.find((each) => each.label === column.label && each.table === column.table);
      return row(column, changed);
    }));
  }
}

function row(column, changed) {
  const before = peakOf(column);
  const after = changed ? peakOf(changed) : before;
  const unit = column.unit ? ` ${column.unit}` : "";
  const title = `${column.table ?? ""}`;
  return element("tr", {},
    element("th", { scope: "row", title }, column.label, element("small", {}, unit)),
    element("td", {}, told(before)), element("td", {}, changed ? told(after) : ""), element("td", {}, changed ? difference(before, after) : ""));
}

/** The value of the largest magnitude; nan where there is none. */
export function peakOf({ values, rounding }) {
  let peak = NaN;
  for (const value of numbers(values)) if (Number.isFinite(value) && !(Math.abs(value) <= Math.abs(peak))) peak = value;
  return Math.abs(peak) <= rounding ? 0 : peak;
}

/** In percent of what it was. */
function difference(before, after) {
  if (before === after) return "0 %";
  const share = (100 * (after - before)) / Math.abs(before);
  if (!Number.isFinite(share)) return told(after - before);
  return `${share > 0 ? "+" : ""}${told(share, 3)} %`;
}
