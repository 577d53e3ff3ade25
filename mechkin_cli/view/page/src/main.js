// The page: reads its data, puts player, stage, curves, tables and notes on it, and tells in words what cannot be done.

import { choice, find } from "./dom.js";
import { givenData, keepPlace, tellLive, tellShown } from "./held.js";
import { listenToKeys } from "./keyboard.js";
import { Curves } from "./panels/curves.js";
import { showLegend } from "./panels/legend.js";
import { ParentWindow } from "./live/messages.js";
import { SaveMenu, liveRun, showLive, showWhyStill } from "./live/start.js";
import { showHelp, showNotes } from "./panels/notes.js";
import { Tables } from "./panels/tables.js";
import { Tabs } from "./panels/tabs.js";
import { Tools } from "./panels/tools.js";
import { preparePaper } from "./paper.js";
import { Player } from "./player.js";
import { csvOf } from "./export/csv.js";
import { saves } from "./export/save.js";
import { Drag } from "./scene/drag.js";
import { NoWebGL } from "./scene/stage.js";
import { Theatre } from "./scene/theatre.js";
import { State } from "./state.js";
import { Theme } from "./theme.js";

const INK = {
  light: { background: "#f6f7f9", grid: "#c3c8d0" },
  dark: { background: "#14171c", grid: "#3a414c" },
  paper: { background: "#ffffff", grid: "#d5d9df" },
};

async function start() {
  const theme = new Theme();
  find("#choices").append(theme.button);
  const { data, place } = await givenData();
  if (data === null) {
    say("This page has no data yet: `mechkin view FILE` writes it with a mechanism.");
    return;
  }
  find("#title").textContent = data.name ?? data.file ?? "mechanism";
  find("#subtitle").textContent = [data.file, data.program].filter(Boolean).join(", ");
  document.title = `${data.name ?? data.file}: mechkin view`;
  const tabs = new Tabs(find("#tabs"));
  const shown = data.runs.length > 0 ? showRuns(data, theme, tabs) : null;
  if (!shown) say("Nothing of this file has been run, so there is nothing to draw.");
  const notes = showNotes(find("#notes"), data);
  tabs.add("notes", notes > 0 ? `Notes (${notes})` : "Notes");
  showHelp(find("#help"), data);
  tabs.add("help", "Help");
  if (shown) keepPlace(place, shown);
  tellShown();
  if (!shown) return;
  await enliven(shown);
  tellLive((window.mechkin.dimensions?.parameters ?? []).map(({ name }) => name));
}

/** Where the page has a kernel, dimensions can be changed; else it is as its file is, and says why. */
async function enliven(shown) {
  const parent = new ParentWindow(shown.state);
  const bring = (run) => {
    window.mechkin.dimensions = showLive(run, shown);
    parent.follow(window.mechkin.dimensions);
  };
  window.mechkin.bring = bring;
  try {
    const run = await liveRun(shown.data);
    if (run) bring(run);
    else showWhyStill(shown.data);
  } catch (error) {
    console.warn(`dimensions cannot be changed here: ${error.message}`);
  }
}

function showRuns(data, theme, tabs) {
  const state = new State(data);
  offerRuns(data, state);
  const player = new Player(find("#player"), state);
  const curves = new Curves(find("#curves"), state, theme);
  tabs.add("curves", "Curves");
  const tables = new Tables(find("#tables"), state, theme);
  tabs.add("tables", data.tables.length > 1 ? `Tables (${data.tables.length})` : "Table");
  const theatre = raise(data, state, theme);
  const tools = theatre && new Tools(find("#tools"), state, theatre);
  if (theatre) {
    showLegend(find("#legend"), data, theatre);
    new Drag(theatre, state, player, (text) => (find("#said").textContent = text));
  }
  const menu = new SaveMenu(find("#choices"), saves({ data, state, theatre, curves, tables, player }));
  preparePaper(theme, theatre);
  listenToKeys({
    state, player,
    actions: {
      forces: () => tools?.toggleForces(), names: () => tools?.toggleNames(),
      home: () => theatre?.home(), look: (axis, back) => tools?.look(axis, back),
    },
  });
  Object.assign(window.mechkin, hooks({ data, state, player, curves, theatre }));
  return { data, state, tabs, menu, player, theatre, theme };
}

function offerRuns(data, state) {
  if (data.runs.length < 2) return;
  const names = data.runs.map((run) => (run.title && run.title !== run.name ? `${run.name}: ${run.title}` : run.name));
  const runs = choice("Run", names, (k) => state.setRun(data.runs[k].name));
  find("#choices").prepend(runs);
  state.watch(() => (runs.value = data.runs.indexOf(state.run)));
}

/** The stage, or null, and why, where the browser cannot draw. */
function raise(data, state, theme) {
  const host = find("#stage");
  try {
    const theatre = new Theatre(host, state);
    const paint = () => theatre.stage.setTheme(INK[theme.printing ? "paper" : theme.dark ? "dark" : "light"]);
    theme.addEventListener("change", paint);
    paint();
    const { domElement } = theatre.stage.renderer;
    domElement.addEventListener("webglcontextlost", () => say("The browser took the drawing's memory away; it comes back when the page is loaded again. Curves and tables work."));
    domElement.addEventListener("webglcontextrestored", () => say(null));
    return theatre;
  } catch (error) {
    if (!(error instanceof NoWebGL)) throw error;
    say(`This browser gives no WebGL, so the mechanism cannot be drawn here; curves and tables work. (${error.message})`);
    return null;
  }
}

/** Words in place of the drawing; null takes them away. */
function say(text) {
  const words = find("#no-drawing");
  words.textContent = text ?? "";
  words.hidden = text === null;
  document.body.classList.toggle("no-drawing", text !== null);
}

/** What tests, and the browser's console, may ask and do. */
function hooks({ data, state, player, curves, theatre }) {
  const link = (name) => data.links.findIndex((each) => each.name === name);
  return {
    data, state, curves, theatre,
    seek: (row) => state.seek(row),
    row: () => state.row,
    pose: (name) => theatre.pose(link(name)),
    setRun: (name) => state.setRun(name),
    setBranch: (name) => state.setBranch(name),
    play: () => player.play(),
    pause: () => player.pause(),
    csv: (number) => csvOf(state.tables[number], state.branches()[0]),
  };
}

window.mechkin = {};
window.mechkin.ready = start().then(
  () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true)))),
  (error) => {
    say(`The page cannot show its data: ${error.message}`);
    tellShown();
    throw error;
  },
);
