// Curves of any columns: one plot for each unit, a common cursor, a click that seeks, marks and verdicts.

import uPlot from "uplot";
import { MARKS, curveColour } from "../colours.js";
import { numbers } from "../data.js";
import { element } from "../dom.js";
import { levelled, told } from "../numbers.js";
import { ColumnChoice } from "./column_choice.js";

const FIRST_COLUMNS = 3;
const LEAST_HEIGHT = 220;
const MOST_HEIGHT = 420;
const ON_PAPER = 690; // pixels: the width of an A4 or letter page between its margins
const BESIDE = 110; // pixels of the panel that are no plot
const DASHES = [[6, 4], [2, 3], [10, 3, 2, 3], [1, 4]];

/** Draws the chosen columns of the run that is shown. */
export class Curves {
  constructor(host, state, theme) {
    this.host = host;
    this.state = state;
    this.theme = theme;
    this.plots = [];
    this.chosen = new Map(); // by run: the keys of its columns
    this.choice = new ColumnChoice((keys) => {
      this.chosen.set(state.run.name, keys);
      this.#draw();
    });
    this.remark = element("p.remark");
    this.empty = element("p.empty", {}, "No column is chosen.");
    this.marks = element("ul.marks");
    this.plotted = element("div.plots");
    host.append(this.choice.node, this.remark, this.plotted, this.empty, this.marks);
    this.sync = uPlot.sync("mechkin");
    new ResizeObserver(() => this.#fit()).observe(this.plotted);
    theme.addEventListener("change", () => this.#draw());
    state.watch((changes) => this.#change(changes));
  }

  #change(changes) {
    if (changes.has("run")) this.#offer();
    if (["run", "branch", "compare"].some((each) => changes.has(each))) this.#draw();
    else if (changes.has("dimensions") && this.plotted.clientWidth === 0 && !this.theme.printing) this.stale = true;
    else if (changes.has("dimensions")) this.#refresh();
    else this.#moveCursor();
  }

  /** The columns of a run: those of its tables, in their order; the first few are chosen. */
  #offer() {
    const { run } = this.state;
    const columns = run.branches[0]?.columns ?? [];
    const { x } = this.state.branch;
    const usual = columns.filter((column) => hasNumbers(column) && !isX(column, x)).slice(0, FIRST_COLUMNS).map(keyOf);
    const keys = this.chosen.get(run.name) ?? new Set(usual);
    this.chosen.set(run.name, keys);
    this.choice.offer(columns.map((column) => ({ ...column, key: keyOf(column) })), keys);
  }

  #draw() {
    for (const plot of this.plots) plot.destroy();
    const { run, branch } = this.state;
    const keys = this.chosen.get(run.name);
    const columns = branch.columns.filter((column) => keys.has(keyOf(column)));
    this.axis = new RowAxis(branch);
    const units = [...new Set(columns.map((column) => column.unit))];
    const colours = new Map(columns.map((column, k) => [keyOf(column), curveColour(k)]));
    this.choice.paint(colours);
    this.plots = units.map((unit, k) =>
      this.#plot(unit, columns.filter((column) => column.unit === unit), colours, k === units.length - 1, units.length),
    );
    this.empty.hidden = columns.length > 0;
    const others = this.#others().map(({ name }) => name);
    this.remark.textContent = others.length > 0 ? `dashed: ${others.join(", ")}` : "";
    this.#listMarks();
    this.#moveCursor();
  }

  /** New numbers in the same plots. */
  #refresh() {
    this.stale = false;
    const { branch } = this.state;
    const byRow = this.axis.byRow;
    this.axis = new RowAxis(branch);
    if (this.axis.byRow !== byRow) return this.#draw();
    for (const plot of this.plots) {
      const values = plot.columns.map(({ key, other }) => {
        const column = (other?.branch ?? branch).columns.find((each) => keyOf(each) === key);
        if (!column) return this.axis.x.map(() => null);
        return other ? other.axis.onto(this.axis, rounded(column)) : this.axis.sorted(rounded(column));
      });
      plot.setData([this.axis.x, ...values]);
    }
    this.#listMarks();
    return this.#moveCursor();
  }

  #plot(unit, columns, colours, last, count) {
    const { run, branch } = this.state;
    const ink = this.theme.colour("--ink-soft");
    const grid = { stroke: this.theme.colour("--line"), width: 1 };
    const axis = { stroke: ink, grid, ticks: grid, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 20 };
    const curves = columns.map((column) => ({
      key: keyOf(column),
      series: { label: column.label, stroke: colours.get(keyOf(column)), width: 1.8, points: { show: branch.rows < 2 } },
      values: this.axis.sorted(rounded(column)),
    }));
    for (const other of this.#others()) {
      for (const column of columns) {
        const match = other.branch.columns.find((each) => keyOf(each) === keyOf(column));
        if (!match) continue;
        const values = other.axis.onto(this.axis, rounded(match));
        curves.push({
          key: keyOf(column),
          other,
          series: { label: `${column.label}, ${other.name}`, stroke: colours.get(keyOf(column)), width: 1, dash: DASHES[other.index % DASHES.length], points: { show: false } },
          values,
        });
      }
    }
    const { label, unit: xUnit } = run.x;
    const options = {
      width: this.#width(),
      height: this.#height(count),
      cursor: { sync: { key: this.sync.key }, drag: { x: true, y: false }, focus: { prox: 24 } },
      legend: { show: false }, // the chips above the plots are the legend
      scales: { x: { time: false }, y: { range: (_, low, high) => (low === null ? [null, null] : uPlot.rangeNum(...levelled(low, high), 0.1, true)) } },
      axes: [
        { ...axis, label: last ? (this.axis.byRow ? "row" : withUnit(label, xUnit)) : undefined, labelSize: last ? 20 : 0, size: last ? 36 : 28 },
        { ...axis, label: withUnit(columns.length === 1 ? columns[0].label : "", unit), size: 62, values: (_, ticks) => ticks.map((tick) => told(tick, 4)) },
      ],
      series: [{ label }, ...curves.map((curve) => curve.series)],
      hooks: {
        draw: [(plot) => this.#paint(plot)],
        ready: [(plot) => this.#listen(plot)],
      },
    };
    const plot = new uPlot(options, [this.axis.x, ...curves.map((curve) => curve.values)], this.plotted);
    plot.columns = curves;
    plot.xName = this.axis.byRow ? "row" : withUnit(label, xUnit);
    plot.yName = withUnit(columns.length === 1 ? columns[0].label : "", unit);
    return plot;
  }

  /** What is drawn dashed: the original beside changed dimensions, other modes where they are compared. */
  #others() {
    const { branch: shown, shownOriginal, compare } = this.state;
    const modes = compare ? this.state.branches() : [];
    const others = modes
      .map((branch, index) => ({ branch, index, name: branch.name }))
      .filter(({ branch }) => branch !== shown && branch.poseCount > 0);
    if (shownOriginal) others.unshift({ branch: shownOriginal, index: 0, name: "original" });
    return others.map((each) => ({ ...each, axis: new RowAxis(each.branch) }));
  }

  /** A click, not the end of a drag that zooms, shows the row below the cursor. */
  #listen(plot) {
    plot.line = element("div.line");
    plot.over.append(plot.line);
    this.#moveLine(plot);
    let from = null;
    plot.over.addEventListener("pointerdown", (event) => (from = [event.clientX, event.clientY]));
    plot.over.addEventListener("click", (event) => {
      if (from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4) return;
      const box = plot.over.getBoundingClientRect();
      const at = plot.posToIdx(event.clientX - box.left);
      this.state.seek(this.axis.rowOf(at));
    });
  }

  /** Verdicts below and marks across. */
  #paint(plot) {
    const { branch } = this.state;
    const brush = plot.ctx;
    const { left, top, width, height } = plot.bbox;
    const ratio = uPlot.pxRatio;
    const across = (x) => Math.round(plot.valToPos(x, "x", true));
    brush.save();
    brush.beginPath();
    brush.rect(left, top, width, height);
    brush.clip();
    for (const { code, from, to } of branch.stretches()) {
      const word = branch.words[code] ?? "";
      if (word === "ok") continue;
      const [first, last] = [this.axis.places[from], this.axis.places[to]].sort((a, b) => a - b);
      const { x } = this.axis;
      const left = across((x[first] + (x[first - 1] ?? x[first])) / 2);
      const right = across((x[last] + (x[last + 1] ?? x[last])) / 2);
      brush.fillStyle = branch.colour(code);
      brush.fillRect(left, top + height - 5 * ratio, Math.max(right - left, ratio), 5 * ratio);
    }
    brush.lineWidth = 1.5 * ratio;
    brush.setLineDash([5 * ratio, 4 * ratio]);
    for (const mark of branch.marks) {
      const place = this.axis.placeOf(mark.x);
      if (place === null) continue;
      brush.strokeStyle = MARKS[mark.kind] ?? MARKS.event;
      stroke(brush, across(place), top, height);
    }
    brush.restore();
    this.#moveLine(plot);
  }

  #listMarks() {
    this.marks.replaceChildren(...this.state.branch.marks.map((mark) =>
      element("li", {},
        element("button", { type: "button", style: { "--mark": MARKS[mark.kind] ?? MARKS.event }, on: { click: () => this.state.seek(this.state.branch.rowAt(mark.x)) } },
          `${mark.kind.replace("-", " ")} at ${told(mark.x)}: ${mark.text}`)),
    ));
  }

  #moveCursor() {
    for (const plot of this.plots) this.#moveLine(plot);
    this.choice.tell((key) => {
      const column = this.state.branch.columns.find((each) => keyOf(each) === key);
      return column ? told(rounded(column)[this.state.row], 6, largest(numbers(column.values))) : "";
    });
  }

  /** The line at the row that is shown lies over the plot, which is not painted again for it. */
  #moveLine(plot) {
    const at = this.axis.places[this.state.row];
    if (at !== undefined && plot.line) plot.line.style.transform = `translateX(${plot.valToPos(this.axis.x[at], "x")}px)`;
  }

  #width() {
    return this.theme.printing ? ON_PAPER : Math.max(260, this.plotted.clientWidth);
  }

  /** So high that the plots fill the panel, where there are few. */
  #height(count) {
    const each = (this.host.clientHeight - BESIDE) / Math.max(1, count) - 4;
    return Math.min(MOST_HEIGHT, Math.max(LEAST_HEIGHT, Math.round(each)));
  }

  #fit() {
    if (this.plotted.clientWidth < 50) return;
    if (this.stale) this.#refresh();
    const width = this.#width();
    for (const plot of this.plots) if (plot.width !== width) plot.setSize({ width, height: this.#height(this.plots.length) });
  }
}

/** Rows in the order in which x grows, as a plot needs them; by their numbers where x goes to and fro. */
class RowAxis {
  constructor(branch) {
    this.branch = branch;
    this.byRow = branch.direction === 0;
    this.rows = Array.from({ length: branch.rows }, (_, k) => (branch.direction < 0 ? branch.rows - 1 - k : k));
    this.places = [];
    this.rows.forEach((row, at) => (this.places[row] = at));
    this.x = this.byRow ? this.rows.map((row) => row + 1) : this.rows.map((row) => branch.x[row]);
  }

  /** Values in the plot's order; what is empty is a gap. */
  sorted(values) {
    return this.rows.map((row) => (Number.isFinite(values[row]) ? values[row] : null));
  }

  /** Values of this axis's branch at the places of another, the nearest row's each. */
  onto(other, values) {
    if (this.byRow || other.byRow) return other.rows.map((row) => finite(values[row]));
    let at = 0;
    return other.x.map((x) => {
      while (at + 1 < this.x.length && Math.abs(this.x[at + 1] - x) <= Math.abs(this.x[at] - x)) at += 1;
      return finite(values[this.rows[at]]);
    });
  }

  rowOf(at) {
    return this.rows[at];
  }

  /** Where a value of x stands in the plot; null where rows stand for places. */
  placeOf(x) {
    if (!this.byRow) return x;
    return this.branch.rowAt(x) + 1;
  }
}

/** The numbers of a column, those that are rounding of zero as zero. */
const rounded = ({ values, rounding }) => numbers(values).map((each) => (Math.abs(each) <= rounding ? 0 : each));
const largest = (values) => values.reduce((most, each) => (Math.abs(each) > most ? Math.abs(each) : most), 0);
const finite = (value) => (Number.isFinite(value) ? value : null);
const keyOf = (column) => `${column.table ?? ""}\u0000${column.label}`;
const withUnit = (label, unit) => (unit ? (label ? `${label} in ${unit}` : unit) : label);
const hasNumbers = (column) => numbers(column.values).some(Number.isFinite);

/** Whether a column only says again what the plots run over. */
const isX = (column, x) => numbers(column.values).every((value, row) => Math.abs(value - x[row]) <= 1e-9 * Math.abs(x[row]));

function stroke(brush, x, top, height) {
  brush.beginPath();
  brush.moveTo(x, top);
  brush.lineTo(x, top + height);
  brush.stroke();
}
