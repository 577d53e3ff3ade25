// A page that another holds in a frame: its data may come by message, and the reader's place in it goes over to the next one.

import { checked, readData } from "./data.js";
import { warmUp } from "./scene/stage.js";

const held = window.parent !== window;
// a page without an origin cannot be named, nor can its holder; nothing in the messages is secret from who holds the page
const post = (message) => held && window.parent.postMessage(message, "*");

/** The data in the page, or those that the holder sends where it has none, with the reader's place; null where there is neither. */
export async function givenData() {
  const data = readData();
  if (data !== null || !held) return { data, place: null };
  return new Promise((resolve, reject) => {
    const take = ({ source, data: message }) => {
      if (source !== window.parent || message?.mechkin !== "data") return;
      window.removeEventListener("message", take);
      try {
        resolve({ data: checked(JSON.parse(message.text)), place: message.place ?? null });
      } catch (error) {
        reject(error);
      }
    };
    window.addEventListener("message", take);
    post({ mechkin: "ready" });
    warmUp();
  });
}

/** Tells the holder that all is drawn. */
export function tellShown() {
  let told = false;
  const tell = () => {
    if (!told) post({ mechkin: "shown" });
    told = true;
  };
  requestAnimationFrame(() => requestAnimationFrame(tell));
  setTimeout(tell, 250); // frames that are behind others may have to wait for pictures
}

/** Tells the holder the names of the parameters that can be set from now on. */
export const tellLive = (names) => post({ mechkin: "live", names });

/** Goes to the reader's place in the page before, as far as it is here, and tells the holder where the reader is when asked. */
export function keepPlace(place, shown) {
  if (!held) return;
  if (place) goTo(place, shown);
  view = shown;
}

let view = null; // what is shown, once it is

// from the start, so that a page that fails does not let its holder wait
if (held) {
  window.addEventListener("message", ({ source, data: message }) => {
    if (source !== window.parent) return;
    if (message?.mechkin === "where") post({ mechkin: "place", place: view && placeIn(view) });
    else if (message?.mechkin === "go" && view && message.place) goTo(message.place, view);
  });
}

function placeIn({ state, player, theatre, tabs, theme }) {
  const { run, branch, row, compare } = state;
  const place = {
    run: run.name, branch: branch.name, other: branch !== state.branches()[0], row, x: branch.x[row], rows: branch.rows, compare,
    tab: tabs.opened, playing: player.playing, dark: theme.chosen, scroll: window.scrollY,
  };
  if (theatre) {
    const { camera, controls } = theatre.stage;
    place.camera = theatre.fitted ? null : { position: camera.position.toArray(), up: camera.up.toArray(), target: controls.target.toArray() };
    place.look = theatre.fitted ? [...theatre.fitted] : null;
    place.shown = { names: theatre.shown.names, paths: theatre.shown.paths };
  }
  return place;
}

function goTo(place, { state, player, theatre, tabs, theme }) {
  if (typeof place.dark === "boolean" && place.dark !== theme.dark) theme.toggle();
  state.setRun(place.run);
  state.setBranch(place.branch);
  if (state.compare !== (place.compare ?? state.compare)) state.setCompare(place.compare);
  const isSame = state.branch.rows === (place.rows ?? state.branch.rows);
  state.seek(isSame ? place.row : state.branch.rowAt(place.x));
  tabs.open(tabs.has(place.tab) ? place.tab : tabs.opened);
  if (place.look || place.camera) theatre?.keepView(place);
  if (place.playing) player.play();
  else player.pause();
  window.scrollTo(0, place.scroll ?? window.scrollY);
}
