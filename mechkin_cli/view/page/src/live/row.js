// One parameter: its name, a slider between round numbers, a field for any number, and the way back to the file's value.

import { element } from "../dom.js";

/** The row of a parameter. */
export class DimensionRow {
  constructor(parameter, dimensions) {
    this.parameter = parameter;
    this.dimensions = dimensions;
    const { name, unit } = parameter;
    this.grid = dimensions.grids.get(name);
    const label = unit ? `${name} in ${unit}` : name;
    this.slider = element("input", {
      type: "range", min: this.grid.first, max: this.grid.last, step: 1, "aria-label": label,
      on: { input: () => this.#slide(false), change: () => this.#slide(true) },
    });
    this.field = element("input", {
      type: "number", step: this.grid.step, "aria-label": `${label}, number`,
      on: {
        change: () => this.#write(),
        input: () => this.field.classList.add("writing"),
        keydown: (event) => event.key === "Escape" && this.#leave(),
        blur: () => this.#leave(),
      },
    });
    this.low = element("span.beyond", { "aria-hidden": "true" });
    this.high = element("span.beyond", { "aria-hidden": "true" });
    this.own = element("span.own", { "aria-hidden": "true", style: { "--at": this.grid.share(parameter.value) } });
    this.back = element("button.back", {
      type: "button", title: `Reset ${name} to ${withUnit(parameter.value, unit)}`, "aria-label": `Reset ${name}`, on: { click: () => dimensions.reset(name) },
    }, "↺");
    this.node = element("div.dimension", { role: "group", "aria-label": name },
      element("span.of", { title: name }, name),
      element("div.way", {}, this.low, this.high, this.own, this.slider),
      this.field, element("small", {}, unit ?? ""), this.back);
    this.show();
  }

  #slide(finished) {
    this.dimensions.set(this.parameter.name, this.grid.at(Number(this.slider.value)), finished);
  }

  #write() {
    this.field.classList.remove("writing");
    const value = this.field.valueAsNumber;
    if (Number.isFinite(value)) this.dimensions.set(this.parameter.name, value);
    else this.show();
  }

  #leave() {
    this.field.classList.remove("writing");
    this.show();
  }

  /** The value that is shown. */
  show() {
    const { name, unit } = this.parameter;
    const value = this.dimensions.values[name];
    const index = Math.min(this.grid.last, Math.max(this.grid.first, this.grid.indexOf(value)));
    if (Number(this.slider.value) !== index) this.slider.value = index;
    this.slider.setAttribute("aria-valuetext", withUnit(value, unit));
    if (!this.field.classList.contains("writing")) this.field.value = value;
    const changed = this.dimensions.isChanged(name);
    this.node.classList.toggle("changed", changed);
    this.back.disabled = !changed;
    this.showEnds();
  }

  /** What of the slider's way no longer assembles is grey. */
  showEnds() {
    const { low, high } = this.dimensions.ends.get(this.parameter.name) ?? {};
    this.low.style.setProperty("--from", 0);
    this.low.style.setProperty("--to", low === undefined ? 0 : this.grid.share(low));
    this.high.style.setProperty("--from", high === undefined ? 1 : this.grid.share(high));
    this.high.style.setProperty("--to", 1);
    const ends = [low, high].filter((end) => end !== undefined).map((end) => withUnit(end, this.parameter.unit));
    this.slider.title = ends.length > 0 ? `The mechanism no longer assembles beyond ${ends.join(" and ")}` : "";
  }
}

const withUnit = (value, unit) => (unit ? `${value} ${unit}` : `${value}`);
