// node compute.mjs MODULE < {data, cases: [{name: value}]} > [{end, words, milliseconds, tables}]: what a page computes.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
import { drawnWith } from "../../mechkin_cli/view/page/src/live/drawn.js";
import { kernelOf, LiveRun } from "../../mechkin_cli/view/page/src/live/kernel.js";

const { data, cases, repeat = 1 } = JSON.parse(readFileSync(0, "utf8"));
const run = new LiveRun(await kernelOf(gunzipSync(readFileSync(process.argv[2]))), data);
const bits = (values) => values && ArrayBuffer.isView(values) && Buffer.from(values.buffer, values.byteOffset, values.byteLength).toString("base64");
const found = cases.map((values) => {
  let result = run.compute(values);
  const times = [];
  for (let k = 1; k < repeat; k += 1) {
    result = run.compute(values);
    times.push(result.milliseconds);
  }
  const { end, words, tables, branch, milliseconds } = result;
  times.sort((a, b) => a - b);
  const runs = [];
  for (let k = 1; k < repeat; k += 1) {
    const start = performance.now();
    run.runAlone();
    runs.push(performance.now() - start);
  }
  runs.sort((a, b) => a - b);
  return {
    run: runs[0], end, words, milliseconds: times.length ? times[0] : milliseconds,
    tables: (tables ?? []).map(({ name, rows, columns, status }) => ({ name, rows, status, exact: columns.map(({ exact }) => bits(exact) ?? null) })),
    columns: (branch?.columns ?? []).map(({ table, label, values, rounding }) => ({ table, label, values: bits(values), rounding })),
    poses: branch ? [...branch.poses.values].map((x) => Number(x)) : [],
    arrows: (branch?.arrows ?? []).map(({ name, place, values }) => ({ name, place, values: bits(values) })),
    drawn: branch ? drawnWith(data, data.live.drawing, run.numbers) : {},
  };
});
process.stdout.write(JSON.stringify(found));
