// The player: a slider over the rows, play and pause, speed, modes; it moves the state and shows its place.

import { MARKS } from "./colours.js";
import { choice, element, tick } from "./dom.js";
import { told } from "./numbers.js";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const USUAL_SPEED = 6; // seconds for once through

/** Controls in `host`. */
export class Player {
  constructor(host, state) {
    this.state = state;
    this.playing = false;
    this.forward = 1;
    this.speed = 1;
    this.button = element("button.play", { type: "button", on: { click: () => this.toggle() } });
    this.slider = element("input", {
      type: "range", min: 0, step: 1, "aria-label": "Row",
      on: { input: () => { this.pause(); state.seek(Number(this.slider.value)); } },
    });
    this.track = element("canvas.track", { "aria-hidden": "true" });
    this.where = element("output.where");
    this.verdict = element("span.verdict");
    const speeds = choice("Speed", SPEEDS.map((each) => `${each}×`), (k) => (this.speed = SPEEDS[k]));
    speeds.value = SPEEDS.indexOf(1);
    this.modes = element("span.modes");
    host.append(
      this.button,
      element("div.rail", {}, this.track, this.slider),
      element("div.reading", {}, this.where, this.verdict),
      element("div.settings", {}, this.modes, speeds),
    );
    new ResizeObserver(() => this.#paint()).observe(this.track);
    this.#label();
    state.watch((changes) => this.#show(changes));
  }

  #show(changes) {
    const { branch, row } = this.state;
    if (changes.has("compare") && !changes.has("branch")) this.#offerModes();
    if (changes.has("dimensions")) this.#paint();
    if (changes.has("branch")) {
      this.slider.max = Math.max(0, branch.rows - 1);
      this.slider.disabled = this.button.disabled = branch.rows < 2;
      this.forward = 1;
      this.#offerModes();
      this.#paint();
    }
    this.slider.value = row;
    const { label, unit } = this.state.run.x;
    const text = `${label} = ${told(branch.x[row])} ${unit}`.trim();
    this.slider.setAttribute("aria-valuetext", text);
    this.where.textContent = `${text}, row ${row + 1} of ${branch.rows}`;
    this.where.title = this.where.textContent;
    const word = branch.verdict(row);
    this.verdict.textContent = word;
    this.verdict.style.setProperty("--verdict", branch.colour(branch.codes[row]));
  }

  #offerModes() {
    const branches = this.state.branches();
    const many = branches.length > 1;
    const kept = [];
    if (many) {
      const names = branches.map((each) => each.name);
      const file = this.state.fileBranches();
      const told = (branch, k) => (branch !== file[k] ? " (changed)" : branch.own ? " (the file's)" : "");
      const texts = branches.map((branch, k) => `${branch.name}${told(branch, k)}`);
      const modes = choice("Assembly mode", texts, (k) => this.state.setBranch(names[k]));
      modes.value = branches.indexOf(this.state.branch);
      kept.push(modes, tick("compare", this.state.compare, (on) => this.state.setCompare(on)));
    }
    this.modes.replaceChildren(...kept);
  }

  /** Verdicts of all rows and the marks, as a band below the slider. */
  #paint() {
    const { branch } = this.state;
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(this.track.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.track.clientHeight * ratio));
    Object.assign(this.track, { width, height });
    const brush = this.track.getContext("2d");
    const last = Math.max(1, branch.rows - 1);
    const reach = width / last;
    // a row of doubt must be seen however many rows there are, so bad ones are painted last
    const words = [...new Set(branch.words.keys())].sort((a, b) => branch.doubts[a] - branch.doubts[b]);
    const stretches = branch.stretches();
    for (const code of words) {
      brush.fillStyle = branch.colour(code);
      for (const { from, to } of stretches.filter((each) => each.code === code)) {
        brush.fillRect((from - 0.5) * reach, 0.35 * height, Math.max((to - from + 1) * reach, ratio), 0.3 * height);
      }
    }
    for (const mark of branch.marks) {
      const at = placeOf(branch, mark.x);
      if (at === null) continue;
      brush.fillStyle = MARKS[mark.kind] ?? MARKS.event;
      brush.fillRect(at * reach - ratio, 0, 2 * ratio, height);
    }
  }

  /** The place after a share of once through. */
  placeAt(share) {
    const { branch } = this.state;
    return Math.min(branch.rows - 1, Math.max(0, advanced(branch, 0, share)));
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.playing || this.state.branch.rows < 2) return;
    this.playing = true;
    this.#label();
    this.then = null;
    requestAnimationFrame((now) => this.#step(now));
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.state.seek(this.state.row);
    this.#label();
  }

  #label() {
    this.button.textContent = this.playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  #step(now) {
    if (!this.playing) return;
    const { branch, data } = this.state;
    const seconds = this.then === null ? 0 : Math.min(0.25, (now - this.then) / 1000);
    this.then = now;
    const last = branch.rows - 1;
    const once = data.view?.speed > 0 ? data.view.speed : USUAL_SPEED;
    const moved = (seconds * this.speed) / once;
    let place = advanced(branch, this.state.place, this.forward * moved);
    if (place > last || place < 0) {
      if (branch.closes()) {
        place = place > last ? 0 : last;
      } else {
        this.forward = place > last ? -1 : 1;
        place = place > last ? last : 0;
      }
    }
    // whole places are computed poses: between them the picture passes smoothly
    this.state.seek(place);
    requestAnimationFrame((later) => this.#step(later));
  }
}

/** The place that lies a share of the whole way on: by x where that goes one way, else by rows. */
function advanced(branch, place, share) {
  const last = branch.rows - 1;
  if (branch.direction === 0) return place + share * last;
  const span = branch.x[last] - branch.x[0];
  const low = Math.min(Math.floor(place), last - 1);
  const here = branch.x[low] + (place - low) * (branch.x[low + 1] - branch.x[low]);
  const wished = (here - branch.x[0]) / span + share;
  if (wished > 1) return last + 1;
  if (wished < 0) return -1;
  return placeOf(branch, branch.x[0] + wished * span) ?? place;
}

/** The place between rows where x has a value; null where it has it nowhere. */
function placeOf(branch, value) {
  for (let row = 0; row < branch.rows - 1; row += 1) {
    const [a, b] = [branch.x[row], branch.x[row + 1]];
    if ((a <= value && value <= b) || (b <= value && value <= a)) {
      return a === b ? row : row + (value - a) / (b - a);
    }
  }
  return null;
}
