// The widget of a notebook: holds the page in a frame, and hands parameters and row from one side to the other.

function render({ model, el }) {
  const host = document.createElement("div");
  host.className = "mechkin";
  el.append(host);
  const hear = (message) => {
    if (message.mechkin === "row") give("row", message.row);
    else if (message.mechkin === "parameters") {
      // numbers of a file without parameters are the page's alone
      const own = model.get("parameters");
      const known = Object.entries(message.values).filter(([name]) => name in own);
      give("parameters", { ...own, ...Object.fromEntries(known) });
    } else if (message.mechkin === "live") {
      give("_reach", message.names);
      setParameters();
    }
  };
  const give = (name, value) => {
    model.set(name, value);
    model.save_changes();
  };
  // what the page has said itself it is told again, which changes nothing there
  const setParameters = () => frames.post({ mechkin: "set-parameters", values: model.get("parameters") });
  const setRow = () => frames.post({ mechkin: "set-row", row: model.get("row") });
  const show = () => frames.show(model.get("_data"), frames.place);
  const frames = new Frames(host, (frame) => (frame.srcdoc = model.get("_page")), hear);
  const heard = [["change:_data", show], ["change:parameters", setParameters], ["change:row", setRow]];
  for (const [name, act] of heard) model.on(name, act);
  show().then(setRow);
  return () => {
    for (const [name, act] of heard) model.off(name, act);
    frames.end();
  };
}

export default { render };
