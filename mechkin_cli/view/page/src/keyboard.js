// Keys: the player without a mouse.

/** What each key does, as the help tells it. */
export const KEYS = [
  ["Space", "play or pause"],
  ["← →", "one row back or on; with Shift ten"],
  ["Home End", "first or last row"],
  ["m", "next assembly mode"],
  ["c", "compare all modes"],
  ["f", "forces and moments on or off"],
  ["n", "names on or off"],
  ["0", "the first view again"],
  ["x y z", "look along an axis; with Shift from behind"],
  ["Ctrl+Z Ctrl+Shift+Z", "undo or redo a change of dimensions"],
];

/** Listens to keys wherever no field is being written in. */
export function listenToKeys({ state, player, actions }) {
  const step = (event, sign) => {
    player.pause();
    state.seek(state.row + sign * (event.shiftKey ? 10 : 1));
  };
  const bound = {
    " ": () => player.toggle(),
    ArrowLeft: (event) => step(event, -1),
    ArrowRight: (event) => step(event, 1),
    Home: () => { player.pause(); state.seek(0); },
    End: () => { player.pause(); state.seek(Infinity); },
    m: () => state.nextBranch(),
    c: () => state.setCompare(!state.compare),
    f: () => actions.forces(),
    n: () => actions.names(),
    0: () => actions.home(),
    x: (event) => actions.look([1, 0, 0], event.shiftKey),
    y: (event) => actions.look([0, 1, 0], event.shiftKey),
    z: (event) => actions.look([0, 0, 1], event.shiftKey),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || takes(event.target, event.key)) return;
    const action = bound[event.key] ?? bound[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
  leaveAfterClicks();
}

/** What was clicked keeps no keys: Space plays after it. Who goes by Tab stays where they are. */
function leaveAfterClicks() {
  let byPointer = false;
  const leave = (target, elements) => {
    const pressed = byPointer && target.closest?.(elements);
    if (pressed && pressed.contains(document.activeElement)) document.activeElement.blur();
  };
  document.addEventListener("pointerdown", () => (byPointer = true), true);
  document.addEventListener("keydown", () => (byPointer = false), true);
  document.addEventListener("click", ({ target }) => leave(target, "button, summary, label, input[type=checkbox]"));
  document.addEventListener("change", ({ target }) => leave(target, "select"));
}

/** Whether the key belongs to the element: to a text field or a list of choices, and Space to what it presses. */
function takes(target, key) {
  if (target.matches?.("input[type=search], input[type=number], select, textarea")) return true;
  if (target.matches?.("#dimensions input[type=range]")) return key !== " ";
  return key === " " && target.matches?.("button, summary, input[type=checkbox], [role=tab]");
}
