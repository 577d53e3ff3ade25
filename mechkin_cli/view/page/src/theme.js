// Light or dark: as the system says, until the reader says otherwise. Paper is always light.

import { element } from "./dom.js";

/** The theme of the page; `change` events tell those who paint. */
export class Theme extends EventTarget {
  constructor() {
    super();
    this.system = window.matchMedia("(prefers-color-scheme: dark)");
    this.paper = window.matchMedia("print");
    this.chosen = null;
    this.button = element("button.theme", { type: "button", on: { click: () => this.toggle() } });
    this.system.addEventListener("change", () => this.#apply());
    this.paper.addEventListener("change", () => this.#apply());
    window.addEventListener("beforeprint", () => this.#apply());
    this.#apply();
  }

  get printing() {
    return this.paper.matches;
  }

  get dark() {
    return !this.printing && (this.chosen ?? this.system.matches);
  }

  toggle() {
    this.chosen = !this.dark;
    this.#apply();
  }

  #apply() {
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
    this.button.textContent = this.dark ? "☀" : "☾";
    this.button.title = this.dark ? "Light" : "Dark";
    this.button.setAttribute("aria-label", this.button.title);
    this.dispatchEvent(new Event("change"));
  }

  /** A colour of the style sheet. */
  colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  }
}
