// The motion as a film: the canvas, with its names, recorded while the run plays through once.

const PICTURES = 30; // a second
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/** Whether this browser records films. */
export const canFilm = () => typeof MediaRecorder === "function" && KINDS.some((kind) => MediaRecorder.isTypeSupported(kind));

/**
 * Plays the run through once and records it.
 * @param seconds  how long the film is
 * @returns {Promise<{blob: Blob, ending: string}>}
 */
export async function film(theatre, state, player, seconds) {
  const kind = KINDS.find((each) => MediaRecorder.isTypeSupported(each));
  const { domElement } = theatre.stage.renderer;
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [domElement.width & ~1, domElement.height & ~1];
  const brush = sheet.getContext("2d");
  player.pause();
  const from = state.place;
  const recorder = new MediaRecorder(sheet.captureStream(PICTURES), { mimeType: kind, videoBitsPerSecond: 6e6 });
  const pieces = [];
  recorder.addEventListener("dataavailable", ({ data }) => data.size > 0 && pieces.push(data));
  const ended = new Promise((done) => recorder.addEventListener("stop", done));
  recorder.start();
  const start = performance.now();
  for (let share = 0; share < 1;) {
    share = Math.min(1, (performance.now() - start) / (1000 * seconds));
    state.seek(player.placeAt(share));
    theatre.stage.draw();
    brush.drawImage(domElement, 0, 0);
    theatre.labels.write(brush, domElement.width / theatre.stage.width, theatre.stage.background);
    await new Promise((done) => requestAnimationFrame(done));
  }
  recorder.stop();
  await ended;
  state.seek(from);
  return { blob: new Blob(pieces, { type: kind.split(";")[0] }), ending: kind.includes("mp4") ? "mp4" : "webm" };
}
