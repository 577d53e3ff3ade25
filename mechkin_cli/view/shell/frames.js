// Pages in frames: one that is seen, and behind it one that has loaded already and waits for the next data, so that a change
// is seen as soon as it is drawn and never before. Frames have no rights; they and this one speak by messages alone.

const FRAME_RIGHTS = "allow-scripts allow-downloads allow-modals";
const MOST_WAIT = 8000; // milliseconds after which a page that says nothing is taken as it is

const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

class Frames {
  #spare = null;
  #wanted = 0;
  #busy = null;
  #place = null;

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
    const held = { frame, asks: [] };
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
    else if (data.mechkin === "place") held.asks.splice(0).forEach((tell) => tell(data.place));
    else if (data.mechkin === "live") this.#enliven(held, data);
    else if (held === this.seen) this.hear(data);
  }

  #enliven(held, message) {
    held.live = message;
    if (held === this.seen) this.hear(message);
  }

  /**
   * Where the reader is now: run, mode, row, tab, camera. Only the page that is seen knows, so it is asked each time and nothing
   * that it said before is used. Null where nothing is drawn, or no answer comes.
   */
  async where() {
    const { seen } = this;
    if (!seen) return null;
    const answer = new Promise((tell) => seen.asks.push(tell));
    this.post({ mechkin: "where" });
    return Promise.race([answer, wait(MOST_WAIT).then(() => null)]);
  }

  /**
   * Shows data, a JSON text, where the reader is; gives whether they are seen, and not newer ones instead.
   * @param first  the place of a reader who has not seen any yet
   */
  async show(text, first = null) {
    const number = (this.#wanted += 1);
    this.#place ??= first;
    // one at a time, so that something is seen however fast the data change; of those that wait, the last
    while (this.#busy) {
      await this.#busy.catch(() => null); // which its own caller is told of
      if (number !== this.#wanted) return false;
    }
    this.#busy = this.#put(text);
    try {
      await this.#busy;
    } finally {
      this.#busy = null;
    }
    return true;
  }

  async #put(text) {
    const held = this.#spare ?? this.#open();
    this.#spare = null;
    await held.ready;
    const place = (await this.where()) ?? this.#place;
    held.frame.contentWindow.postMessage({ mechkin: "data", text, place }, "*");
    await Promise.race([held.shown, wait(MOST_WAIT)]);
    // the reader may have gone on while the next page was drawn behind; what is done after this answer would be lost
    if (this.seen) this.seen.frame.inert = true;
    const later = (await this.where()) ?? place;
    if (JSON.stringify(later) !== JSON.stringify(place)) held.frame.contentWindow.postMessage({ mechkin: "go", place: later }, "*");
    // the next one may have been opened meanwhile
    for (const each of [...this.all]) if (each !== held && each !== this.#spare) this.#close(each);
    this.#place = later;
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
