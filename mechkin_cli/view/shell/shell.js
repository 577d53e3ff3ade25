// The page of `mechkin view --live`: holds the mechanism's page in a frame, follows what is seen of its file, and writes
// values of parameters into it. Texts of the file are shown as texts and never as markup.

const find = (selector) => document.querySelector(selector);

function element(name, text, ...inside) {
  const [tag, kind] = name.split(".");
  const made = document.createElement(tag);
  if (kind) made.className = kind;
  if (text) made.textContent = text;
  made.append(...inside);
  return made;
}

/** The file's faults with their places, beside the picture. */
function showFaults(seen) {
  const list = element("ol");
  for (const fault of seen.faults) {
    const parts = [];
    if (fault.place) parts.push(element("div.place", fault.place));
    parts.push(element("div", fault.text));
    if (fault.hint) parts.push(element("div.hint", fault.hint));
    if (fault.source !== null) parts.push(sourceLine(fault));
    list.append(element("li", "", ...parts));
  }
  const what = seen.picture ? "The picture is that of the last sound file." : "There is no picture of this file yet.";
  find("#faults").replaceChildren(element("h2", counted(seen.faults.length, "fault")), element("p.hint", what), list);
  find("#faults").hidden = seen.faults.length === 0;
}

/** The line of a fault, with what stands at its place marked. */
function sourceLine({ line, column, source }) {
  const start = [...source];
  const ahead = start.slice(0, column - 1).join("").trimStart();
  const before = ahead.length > 30 ? `…${ahead.slice(-28)}` : ahead;
  const rest = start.slice(column - 1).join("");
  const word = /^(?:[\w.]+|\S)?/.exec(rest)[0];
  return element("pre", `${line} | ${before}`, element("b", word), rest.slice(word.length));
}

const counted = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;

class Live {
  #source = null;
  #seen = null;
  #own = {};
  #values = {};
  #texts = {};

  constructor() {
    this.shown = 0;
    this.frames = new Frames(find("#page"), (frame) => (frame.src = "frame"), (message) => this.#hear(message));
    find("#write").addEventListener("click", () => this.#write(Object.fromEntries(this.#changed), []));
    // a browser opens only a few connections to one place: pages that nobody sees need none
    document.addEventListener("visibilitychange", () => this.#follow());
    this.#follow();
  }

  #follow() {
    this.#source?.close();
    this.#source = null;
    if (document.hidden) return;
    this.#source = new EventSource("news");
    this.#source.onmessage = ({ data }) => this.#look(JSON.parse(data));
    this.#source.onerror = () => this.#ended();
  }

  #ended() {
    this.#tell("mechkin has ended: start mechkin view --live again", "bad");
    find("#write").hidden = true;
  }

  #tell(text, kind) {
    const state = find("#state");
    state.textContent = text;
    state.className = kind;
  }

  async #look(seen) {
    // a picture that is still on its way says no more what was seen before
    this.#seen = seen;
    if (seen.ended) {
      this.#source.close();
      this.#ended();
      return;
    }
    const { faults, picture } = seen;
    showFaults(seen);
    if (faults.length > 0) this.#tell(counted(faults.length, "fault"), "bad");
    if (picture && picture.number > this.shown) await this.#show(picture);
    if (this.#seen === seen && faults.length === 0) this.#tell("follows the file", "good");
  }

  async #show(picture) {
    const place = await this.frames.where();
    // a picture that has the file's own mode alone knows nothing of another that the reader has chosen
    if (!picture.whole && place?.other) return;
    this.shown = picture.number;
    const text = await fetch(`data/${picture.number}`).then((answer) => (answer.status === 200 ? answer.text() : null), () => null);
    // null: a newer one is on its way, or mechkin has ended
    if (text === null || this.shown !== picture.number || !(await this.frames.show(text))) return;
    document.documentElement.dataset.picture = picture.number;
    this.#takeOwn(picture.parameters);
  }

  /** What the file says now; what the reader had set and the file does not say otherwise is set again. */
  #takeOwn(parameters) {
    const before = this.#own;
    const kept = this.#changed.filter(([name, value]) => parameters[name] === before[name] && value !== parameters[name]);
    this.#own = parameters;
    this.#values = Object.fromEntries(kept);
    this.#setAgain();
    this.#offer();
  }

  #setAgain() {
    const values = Object.fromEntries(this.#changed);
    if (Object.keys(values).length > 0) this.frames.post({ mechkin: "set-parameters", values });
  }

  get #changed() {
    return Object.entries(this.#values).filter(([name, value]) => name in this.#own && value !== this.#own[name]);
  }

  #hear(message) {
    if (message.mechkin === "live") this.#setAgain();
    if (message.mechkin !== "parameters" || typeof message.values !== "object" || message.values === null) return;
    this.#values = message.values;
    this.#texts = message.texts ?? {};
    if (this.asked?.some(([name, value]) => message.values[name] !== value)) this.#ask({}, {});
    this.#offer();
  }

  #offer() {
    const button = find("#write");
    const names = this.#changed.map(([name]) => name);
    button.hidden = names.length === 0;
    button.textContent = `Write ${names.length === 1 ? names[0] : counted(names.length, "value")} into the file`;
    button.title = names.map((name) => `${name}: ${this.#texts[name] ?? this.#values[name]}`).join("\n");
  }

  async #write(values, replace) {
    this.#ask({}, {});
    const hash = this.#seen.picture.hash;
    let words;
    let expressions = {};
    try {
      const answer = await fetch("parameters", { method: "POST", body: JSON.stringify({ hash, values, replace }) });
      if (answer.ok) {
        const done = await answer.json();
        expressions = done.expressions;
        words = Object.entries(done.written).map(([name, text]) => `${name}: ${text}`).join(", ");
        words = words && `written: ${words}`;
      } else {
        words = (await answer.text()).trim();
      }
    } catch (error) {
      words = `nothing was written: ${error.message}`;
    }
    find("#said").textContent = words;
    this.#ask(expressions, values);
  }

  /** Offers to replace what is written with other parameters. */
  #ask(expressions, values) {
    this.asked = Object.keys(expressions).map((name) => [name, values[name]]);
    const buttons = this.asked.map(([name, value]) => {
      const button = element("button", `Replace ${name}: ${expressions[name]}`);
      button.type = "button";
      button.title = `${name} is written as ${expressions[name]}: write ${this.#texts[name] ?? value} in its place`;
      button.addEventListener("click", () => this.#write({ [name]: value }, [name]));
      return button;
    });
    find("#acts").replaceChildren(...buttons, find("#write"));
  }
}

window.live = new Live();
