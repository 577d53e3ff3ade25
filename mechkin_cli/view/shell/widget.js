// The widget of a notebook: holds the page in a frame, and hands parameters and row from one side to the other.

function render({ model, el }) {
  const host = document.createElement("div");
  host.className = "mechkin";
  el.append(host);
  const said = {}; // by the page, last; what it has said itself it is not told again, as it may have gone on meanwhile
  const give = (name, value) => {
    said[name] = JSON.stringify(value);
    model.set(name, value);
    model.save_changes();
  };
  const isNew = (name) => JSON.stringify(model.get(name)) !== said[name];
  const hear = (message) => {
    if (message.mechkin === "row") give("row", message.row);
    else if (message.mechkin === "parameters") {
      // numbers of a file without parameters are the page's alone
      const own = model.get("parameters");
      const known = Object.entries(message.values).filter(([name]) => name in own);
      give("parameters", { ...own, ...Object.fromEntries(known) });
    } else if (message.mechkin === "live") {
      give("_reach", message.names);
      tellParameters();
    }
  };
  const tellParameters = () => frames.post({ mechkin: "set-parameters", values: model.get("parameters") });
  const setParameters = () => isNew("parameters") && tellParameters();
  const setRow = () => isNew("row") && frames.post({ mechkin: "set-row", row: model.get("row") });
  const show = async () => {
    await frames.show(model.get("_data"), { row: model.get("row") });
    const place = await frames.where();
    // the same place may be another row in new data, unless Python has chosen one meanwhile
    if (isNew("row")) setRow();
    else if (Number.isInteger(place?.row)) give("row", place.row);
  };
  const frames = new Frames(host, (frame) => (frame.srcdoc = model.get("_page")), hear);
  const heard = [["change:_data", show], ["change:parameters", setParameters], ["change:row", setRow]];
  for (const [name, act] of heard) model.on(name, act);
  show();
  return () => {
    for (const [name, act] of heard) model.off(name, act);
    frames.end();
  };
}

export default { render };
