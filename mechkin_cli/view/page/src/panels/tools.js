// What is shown on the stage: views, names, paths, floor, and which forces and moments, how long.

import { ARROWS } from "../colours.js";
import { element, tick } from "../dom.js";

const ZOOMS = 2; // decades to either side

/** The toolbar of the stage; gives what keys do, too. */
export class Tools {
  constructor(host, state, theatre) {
    this.state = state;
    this.theatre = theatre;
    this.names = new Set();
    const press = (text, title, click) => element("button", { type: "button", title, "aria-label": title, on: { click } }, text);
    this.ticks = {
      names: tick("names", true, (on) => theatre.setShown("names", on)),
      paths: tick("paths", true, (on) => theatre.setShown("paths", on)),
      floor: tick("floor", true, (on) => theatre.setShown("floor", on)),
    };
    if (state.data.points.length === 0) delete this.ticks.paths;
    if (state.data.planar) delete this.ticks.floor;
    this.arrows = element("div.arrows");
    this.zoom = element("input", {
      type: "range", min: -ZOOMS, max: ZOOMS, step: 0.05, value: 0, "aria-label": "Length of the arrows",
      on: { input: () => theatre.setArrowZoom(10 ** Number(this.zoom.value)) },
    });
    this.forces = element("details.forces", {}, element("summary", {}, "forces"),
      element("div.list", {}, element("label", {}, "length ", this.zoom), this.arrows));
    host.append(
      press("⌂", "First view (0)", () => theatre.home()),
      ...["x", "y", "z"].map((axis, k) => press(axis, `Look along ${axis}`, () => this.look([0, 1, 2].map((each) => Number(each === k))))),
      ...Object.values(this.ticks), this.forces,
    );
    this.on = state.data.view?.forces === true;
    state.watch((changes) => {
      if (changes.has("run")) this.#offer();
      else if (changes.has("dimensions")) this.theatre.setArrows(this.names);
    });
  }

  #offer() {
    const arrows = this.state.branch.arrows;
    this.forces.hidden = arrows.length === 0;
    this.offered = arrows;
    if (this.on) this.names = new Set(arrows.filter(({ kind }) => kind === "force").map(({ name }) => name));
    this.#list();
  }

  #list() {
    this.arrows.replaceChildren(...this.offered.map(({ name, kind }) => {
      const label = tick(name, this.names.has(name), (on) => {
        if (on) this.names.add(name);
        else this.names.delete(name);
        this.theatre.setArrows(this.names);
      });
      label.style.setProperty("--arrow", ARROWS[kind]);
      return label;
    }));
    this.theatre.setArrows(this.names);
  }

  look(axis, back = false) {
    this.theatre.lookFrom(axis.map((each) => (back ? -each : each)));
  }

  /** All forces and moments on, or all off. */
  toggleForces() {
    this.names = new Set(this.names.size > 0 ? [] : this.offered.map(({ name }) => name));
    this.#list();
  }

  toggleNames() {
    this.ticks.names.querySelector("input").click();
  }
}
