// Pages in frames: one that is seen, and behind it one that has loaded already and waits for the next data, so that a change
// is seen as soon as it is drawn and never before. Frames have no rights; they and this one speak by messages alone.

const FRAME_RIGHTS = "allow-scripts allow-downloads allow-modals";
const MOST_WAIT = 8000; // milliseconds after which a page that says nothing is shown as it is

class Frames {
  #spare = null;
  #wanted = 0;
  #busy = null;

  /**
   * @param host  element that frames fill
   * @param load  puts the page without data into a frame
   * @param hear  takes what the page that is seen says: its messages
   */
  constructor(host, load, hear) {
    this.host = host;
    this.load = load;
    this.hear = hear;
    this.seen = null;
    this.all = new Set();
    this.listen = (event) => this.#take(event);
    window.addEventListener("message", this.listen);
    this.#spare = this.#open();
  }

  #open() {
    const frame = document.createElement("iframe");
    frame.title = "The mechanism";
    frame.setAttribute("sandbox", FRAME_RIGHTS);
    frame.allow = "clipboard-write; fullscreen";
    frame.inert = true;
    Object.assign(frame.style, { position: "absolute", inset: 0, width: "100%", height: "100%", border: 0 });
    const held = { frame, place: null };
    held.ready = new Promise((done) => (held.isReady = done));
    held.shown = new Promise((done) => (held.isShown = done));
    this.all.add(held);
    this.load(frame);
    this.host.prepend(frame); // behind those that stand there
    return held;
  }

  #take({ source, data }) {
    const held = [...this.all].find((each) => each.frame.contentWindow === source);
    if (!held || typeof data !== "object" || data === null) return;
    if (data.mechkin === "ready") held.isReady();
    else if (data.mechkin === "shown") held.isShown();
    else if (data.mechkin === "place") held.place = data.place;
    else if (data.mechkin === "live") this.#enliven(held, data);
    else if (held === this.seen) this.hear(data);
  }

  #enliven(held, message) {
    held.live = message;
    if (held === this.seen) this.hear(message);
  }

  /** Where the reader is in the page that is seen: run, mode, row, tab, camera. */
  get place() {
    return this.seen?.place ?? null;
  }

  /** Shows data, a JSON text, at a place; gives whether they are seen, and not newer ones instead. */
  async show(text, place) {
    const number = (this.#wanted += 1);
    // one at a time, so that something is seen however fast the data change; of those that wait, the last
    while (this.#busy) {
      await this.#busy;
      if (number !== this.#wanted) return false;
    }
    this.#busy = this.#put(text, place);
    await this.#busy;
    this.#busy = null;
    return true;
  }

  async #put(text, place) {
    const held = this.#spare ?? this.#open();
    this.#spare = null;
    await held.ready;
    held.frame.contentWindow.postMessage({ mechkin: "data", text, place }, "*");
    await Promise.race([held.shown, new Promise((done) => setTimeout(done, MOST_WAIT))]);
    for (const each of [...this.all]) if (each !== held) this.#close(each);
    this.seen = held;
    held.frame.inert = false;
    if (held.live) this.hear(held.live);
    setTimeout(() => (this.#spare ??= this.#open()), 100);
  }

  #close(held) {
    this.all.delete(held);
    held.frame.remove();
  }

  /** Says something to the page that is seen. */
  post(message) {
    this.seen?.frame.contentWindow.postMessage(message, "*");
  }

  end() {
    window.removeEventListener("message", this.listen);
    for (const each of [...this.all]) this.#close(each);
  }
}
