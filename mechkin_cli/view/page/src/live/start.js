// Brings the page to life where it has a kernel: dimensions that can be changed, and all else that follows them.

import { element, find } from "../dom.js";
import { copy, keep, stemOf } from "../export/save.js";
import { Attached } from "./attached.js";
import { Dimensions } from "./dimensions.js";
import { drawnWith } from "./drawn.js";
import { changedFile, parameterLines } from "./file_text.js";
import { loadKernel } from "./kernel.js";
import { DimensionPanel, showStill } from "./panel.js";
import { Peaks } from "./peaks.js";
import { LiveRuns } from "./runs.js";

/** The run that computes, or null where the data or the browser have none. */
export async function liveRun(data) {
  if (!data.live?.parameters?.length) return null;
  const kernel = await loadKernel();
  return kernel && new LiveRuns(kernel, data);
}

/** Says why nothing can be changed: what the page's writer said of its run, or that the browser has no WebAssembly. */
export function showWhyStill({ file, still, live }) {
  const command = `mechkin analyze ${file} --set NAME=VALUE`;
  if (live) showStill(find("#dimensions"), { why: "this browser cannot run the solver, which is WebAssembly", named: !live.folded, command });
  else if (still?.length) showStill(find("#dimensions"), still[0]);
}

/** Shows the panel of dimensions and lets everything follow; gives the dimensions. */
export function showLive(run, { data, state, tabs, menu }) {
  const live = data.live ?? {};
  const attached = new Attached(data);
  run.shown = () => ({ run: state.run.name, name: state.branch.name });
  const dimensions = new Dimensions(run, (found) => state.setChanged(found && changedOf(data, run, found, attached)));
  // an assembly mode is computed when it is shown
  state.watch((changes) => changes.has("branch") && dimensions.changed && !state.original && dimensions.again());
  const file = live.file;
  // the numbers of a file without parameters are no lines of `parameters:`
  const acts = live.folded ? [] : [{ text: "Copy as parameters", short: "Copy", act: () => copy(parameterLines(dimensions)) }];
  if (file) acts.push({ text: "Download file", short: "Download", act: () => keep(`${stemOf(data)}.yaml`, changedFile(file, dimensions)) });
  document.body.classList.add("live");
  new DimensionPanel(find("#dimensions"), state, dimensions, { fixed: run.fixed ?? [], left: run.left ?? [], folded: live.folded, still: data.still ?? [] }, acts);
  menu?.add(acts);
  new Peaks(find("#peaks"), state);
  tabs.add("peaks", "Peaks", "tables");
  dimensions.lookForEnds();
  return dimensions;
}

/** What was computed, as the state shows it. */
function changedOf(data, run, found, attached) {
  const drawing = data.live?.drawing;
  const drawn = found.drawn ?? (drawing && run.numbers ? drawnWith(data, drawing, run.numbers) : {});
  const runs = found.runs ?? { [data.live?.run ?? data.runs[0].name]: { branch: found.branch, tables: found.tables } };
  return { runs, modes: found.modes ?? {}, drawn: { ...drawn, ...attached.moved(drawn) } };
}

/** The menu of what can be taken along, in the head of the page. */
export class SaveMenu {
  constructor(host, acts) {
    this.list = element("div.list");
    this.said = element("span.copied", { role: "status" });
    this.node = element("details.menu", {}, element("summary", { title: "Files to take along" }, "Save"), this.list);
    host.prepend(this.node, this.said);
    document.addEventListener("pointerdown", ({ target }) => { if (!this.node.contains(target)) this.node.open = false; });
    this.node.addEventListener("keydown", ({ key }) => { if (key === "Escape") this.node.open = false; });
    this.add(acts);
  }

  add(acts) {
    this.list.append(...acts.map(({ text, act }) => element("button", { type: "button", on: { click: () => this.#do(act) } }, text)));
  }

  async #do(act) {
    this.node.open = false;
    this.said.textContent = "…";
    try {
      this.said.textContent = (await act()) ?? "";
    } catch (error) {
      this.said.textContent = `not written: ${error.message}`;
    }
    setTimeout(() => (this.said.textContent = ""), 6000);
  }
}
