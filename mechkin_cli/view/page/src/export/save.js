// What can be taken along: files, made when they are asked for and given to the browser to keep.

import { pictureOf } from "../paper.js";
import { csvOf } from "./csv.js";
import { curvePicture } from "./curve_picture.js";
import { dxfOf, svgOf } from "./drawings.js";
import { canFilm, film } from "./film.js";
import { outlineOf } from "./outline.js";

const FILM = 6; // seconds, where the file gives no speed

/** Keeps a file: a text or a Blob. */
export function keep(name, content, type = "text/plain") {
  const blob = content instanceof Blob ? content : new Blob([content], { type: `${type};charset=utf-8` });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  return `${name} is written`;
}

/** Puts a text where it can be pasted; words where the browser does not let the page. */
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return "copied";
  } catch {
    // pages from a file may not use the clipboard in some browsers: the older way
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    return done ? "copied" : "the browser does not let this page copy";
  }
}

/** What every page can give: [{text, act}]. */
export function saves({ data, state, theatre, curves, tables, player }) {
  const stem = stemOf(data);
  const found = [];
  if (data.tables.length > 0) {
    found.push({ text: "Table as CSV", act: () => keep(`${safe(tables.shown.name)}.csv`, csvOf(tables.shown, tables.own), "text/csv") });
  }
  found.push({ text: "Curves as SVG", act: () => keep(`${stem}-curves.svg`, curvePicture(curves.plots, data.name ?? stem), "image/svg+xml") });
  if (!theatre) return found;
  found.push(
    { text: "Picture as PNG", act: async () => keep(`${stem}.png`, await blobOf(pictureOf(theatre))) },
    { text: "Picture as SVG", act: () => keep(`${stem}.svg`, svgOf(outlineOf(theatre), { unit: data.units.length, title: data.name ?? stem }), "image/svg+xml") },
    { text: "Picture as DXF", act: () => keep(`${stem}.dxf`, dxfOf(outlineOf(theatre)), "image/vnd.dxf") },
  );
  if (canFilm()) {
    found.push({ text: "Motion as film", act: async () => {
      const { blob, ending } = await film(theatre, state, player, data.view?.speed > 0 ? data.view.speed : FILM);
      return keep(`${stem}.${ending}`, blob);
    } });
  }
  return found;
}

const blobOf = (sheet) => new Promise((done) => sheet.toBlob(done, "image/png"));

/** The name of the file without its ending, as a name of files. */
export function stemOf(data) {
  const stem = (data.file || data.name || "mechanism").replace(/\.[^.]*$/, "");
  return safe(stem) || "mechanism";
}

const safe = (text) => text.replaceAll(/[^\w.-]+/g, "_").slice(0, 80);
