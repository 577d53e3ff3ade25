// The panel of dimensions: for each parameter a slider, a field for its number and a way back; undo and redo.

import { element, tick } from "../dom.js";
import { written } from "./file_text.js";
import { DimensionRow } from "./row.js";

/** The panel in `host`. */
export class DimensionPanel {
  /**
   * @param left  columns of tables that do not follow: {table, label, why, command}
   * @param still  runs that do not follow at all: {run, why}
   * @param folded  what the numbers of a file without parameters are called together; they are folded away at first
   */
  constructor(host, state, dimensions, { fixed, left, folded, still }, acts) {
    this.dimensions = dimensions;
    this.still = new Map(still.map(({ run, why }) => [run, why]));
    const press = (text, title, click) => element("button", { type: "button", title, "aria-label": title, on: { click } }, text);
    this.back = press("↶", "Undo (Ctrl+Z)", () => dimensions.undo());
    this.on = press("↷", "Redo (Ctrl+Shift+Z)", () => dimensions.redo());
    this.reset = press("Reset", "Reset all dimensions to the file's", () => dimensions.resetAll());
    this.copied = element("span.copied", { role: "status" });
    this.words = element("p.words", { role: "status" });
    this.modes = element("p.remark");
    this.original = tick("original", state.withOriginal, (on) => state.setWithOriginal(on));
    this.original.title = "Draw the file's own dimensions pale, and their curves dashed";
    this.rows = dimensions.parameters.map((parameter) => new DimensionRow(parameter, dimensions));
    const takes = acts.map(({ text, short, act }) => press(short, text, () => this.#act(act)));
    host.replaceChildren(
      element("summary", {}, element("h2", {}, "Dimensions")),
      element("div.actions", { role: "toolbar", "aria-label": "Dimensions" }, this.back, this.on, this.reset, this.original, ...takes, this.copied),
      this.words,
      this.#listed(folded),
      this.modes,
      ...listed("Changed by a command only", fixed.map(({ name, why, command }) => ({ names: [name], why, command }))),
      ...listed("Empty with changed dimensions", grouped(left)),
    );
    host.hidden = false;
    for (const event of ["change", "settle"]) dimensions.addEventListener(event, () => this.#show());
    dimensions.addEventListener("ends", () => this.rows.forEach((row) => row.showEnds()));
    dimensions.addEventListener("words", () => (this.words.textContent = dimensions.words));
    state.watch(() => this.#tellModes(state));
    listen(dimensions);
    this.commands = host.querySelectorAll("code[data-command]");
    this.#show();
  }

  #listed(folded) {
    const rows = element("div.rows", {}, ...this.rows.map(({ node }) => node));
    if (!folded) return rows;
    return element("details.fixed", {}, element("summary", {}, `${folded} (${this.rows.length})`), rows);
  }

  async #act(act) {
    this.copied.textContent = (await act()) ?? "";
  }

  #show() {
    const { history, changed } = this.dimensions;
    this.back.disabled = !history.canUndo;
    this.on.disabled = !history.canRedo;
    this.reset.disabled = !changed;
    this.copied.textContent = "";
    for (const row of this.rows) row.show();
    for (const code of this.commands) code.textContent = commandOf(code.dataset.command, this.dimensions);
  }

  #tellModes(state) {
    const { changed } = this.dimensions;
    let text = "";
    if (changed && !state.original) {
      const runs = state.branches()[0] === state.fileBranches()[0];
      text = runs
        ? `This run is shown with the file's dimensions: ${this.still.get(state.run.name) ?? "it does not follow the changed ones"}.`
        : "This assembly mode is shown with the file's dimensions: it cannot be followed to the changed ones.";
    } else if (changed && state.branches().length > 1) {
      text = "Assembly modes are called by their letters in the file; with the changed dimensions they may have others.";
    }
    this.modes.textContent = text;
  }
}

/** In place of the panel, where nothing of the page can be changed: why, and the command that does. */
export function showStill(host, { why, named, command }) {
  const names = named ? "" : "Name the numbers under parameters: in the file, and set them by ";
  host.replaceChildren(
    element("summary", {}, element("h2", {}, "Dimensions")),
    element("p.remark", {}, `They cannot be changed in this page: ${why}. ${names}`, element("code", {}, command), named ? " computes it with others." : ""),
  );
  host.hidden = false;
}

/** What this page does not do, why, and the command that does. */
function listed(title, all) {
  if (all.length === 0) return [];
  const items = all.map(({ names, why, command }) =>
    element("li", {}, element("b", {}, names.join(", ")), `: ${why} `, ...(command ? [element("code", { data: { command } }, command)] : [])));
  return [element("details.fixed", {}, element("summary", {}, title, ` (${all.reduce((sum, { names }) => sum + names.length, 0)})`), element("ul", {}, ...items))];
}

/** Columns that are left out for one reason, together. */
function grouped(left) {
  const found = new Map();
  for (const { table, label, why, command } of left) {
    if (!found.has(why)) found.set(why, { names: [], why, command });
    found.get(why).names.push(`${label} of ${table}`);
  }
  return [...found.values()];
}

/** A command with the changed values in it. */
function commandOf(command, dimensions) {
  const changed = dimensions.parameters.filter(({ name }) => dimensions.isChanged(name));
  const given = changed.map((each) => `${each.name}=${quoted(written(each, dimensions.values[each.name]).replaceAll(" ", ""))}`);
  return given.length > 0 ? command.replace("NAME=VALUE", given.join(" --set ")) : command;
}

const quoted = (text) => (/^[\w.+-]*$/.test(text) ? text : `'${text}'`);

/** Ctrl+Z and Ctrl+Shift+Z, or Ctrl+Y, wherever no text is being written. */
function listen(dimensions) {
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.matches?.("input[type=search], input.writing, textarea")) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) dimensions.redo();
    else dimensions.undo();
  });
}
