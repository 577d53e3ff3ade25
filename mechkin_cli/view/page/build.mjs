// Builds ../page.html, one file with everything in it; `--check` compares it with what is committed, byte by byte.

import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const MOST_BYTES = 1_600_000;
const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const page = here("../page.html");

const options = {
  bundle: true,
  minify: true,
  charset: "utf8",
  legalComments: "none", // the licences stand at the end of the page, whole
  target: ["chrome100", "firefox100", "safari15.4"],
  write: false,
  absWorkingDir: here("."),
};

async function bundled(entry, more = {}) {
  const result = await build({ ...options, entryPoints: [entry], ...more });
  // nothing in the text may end the element that it stands in
  return result.outputFiles[0].text.trim().replaceAll(/<\/(script|style)/g, "<\\/$1").replaceAll("<!--", "<\\!--");
}

const hash = (text) => createHash("sha256").update(text, "utf8").digest("base64");

async function licences() {
  const names = ["three", "uplot"];
  const texts = await Promise.all(names.map(async (name) => {
    const { version } = JSON.parse(await readFile(here(`node_modules/${name}/package.json`), "utf8"));
    const licence = await readFile(here(`node_modules/${name}/LICENSE`), "utf8");
    return `${name} ${version}\n\n${licence.replaceAll("\r\n", "\n").trim()}`;
  }));
  const text = `This page contains these libraries.\n\n${texts.join("\n\n")}`;
  if (text.includes("--")) throw new Error("a licence holds what would end a comment");
  return `<!--\n${text}\n-->`;
}

async function made() {
  const [template, script, style] = await Promise.all([
    readFile(here("index.html"), "utf8"),
    bundled("src/main.js", { format: "iife" }),
    bundled("style/main.css"),
  ]);
  const kernel = await readFile(here("../../kernel/wasm/mechkin.wasm.gz"), "base64");
  const parts = { kernel, style, script, "style-hash": hash(style), "script-hash": hash(script) };
  const filled = template.replaceAll(/\{\{([a-z-]+)\}\}/g, (_, name) => parts[name]);
  const text = `${filled.trimEnd()}\n${await licences()}\n`;
  const bytes = Buffer.byteLength(text, "utf8");
  if (bytes > MOST_BYTES) throw new Error(`the page has ${bytes} bytes, and ${MOST_BYTES} are allowed`);
  if (text.split("/*mechkin-data*/null").length !== 2) throw new Error("the place for the data must occur once");
  return text;
}

const text = await made();
if (process.argv.includes("--check")) {
  const kept = await readFile(page, "utf8").catch(() => "");
  if (kept !== text) {
    console.error("page.html is not what its sources give: run `npm run build` in mechkin_cli/view/page");
    process.exit(1);
  }
  console.log(`page.html is what its sources give: ${Buffer.byteLength(text)} bytes`);
} else {
  await writeFile(page, text);
  console.log(`page.html: ${Buffer.byteLength(text)} bytes`);
}
