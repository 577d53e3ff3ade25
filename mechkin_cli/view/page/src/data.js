// The data of the page: JSON in which arrays of numbers are base64, decoded where they are first read.

const KINDS = { f32: Float32Array, f64: Float64Array, i32: Int32Array, u8: Uint8Array };
const decoded = new WeakMap();

/** The numbers of `{"f64": "..."}` and its like, little-endian as every browser's machine is; an array of numbers is itself. */
export function numbers(packed) {
  if (!packed) return new Float64Array(0);
  if (ArrayBuffer.isView(packed)) return packed;
  let made = decoded.get(packed);
  if (!made) {
    const [kind, text] = Object.entries(packed)[0];
    made = new KINDS[kind](bytes(text).buffer);
    decoded.set(packed, made);
  }
  return made;
}

function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text);
  const made = new Uint8Array(characters.length);
  for (let at = 0; at < characters.length; at += 1) made[at] = characters.charCodeAt(at);
  return made;
}

/** The data that `mechkin view` put into the page, or null where there is none. */
export function readData() {
  const data = JSON.parse(document.getElementById("mechkin-data").textContent);
  if (data && data.format !== 1) {
    throw new Error(`the page reads format 1 of its data, and this is format ${data.format}`);
  }
  return data;
}
