// node compute.mjs MODULE < {data, cases: [{name: value}], shown: {run, name} of a mode} > [{end, words, milliseconds, tables}]: what a page computes.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
import { drawnWith } from "../../mechkin_cli/view/page/src/live/drawn.js";
import { kernelOf } from "../../mechkin_cli/view/page/src/live/kernel.js";
import { LiveRuns } from "../../mechkin_cli/view/page/src/live/runs.js";

const { data, cases, repeat = 1, shown = null } = JSON.parse(readFileSync(0, "utf8"));
const run = new LiveRuns(await kernelOf(gunzipSync(readFileSync(process.argv[2]))), data);
const bits = (values) => values && ArrayBuffer.isView(values) && Buffer.from(values.buffer, values.byteOffset, values.byteLength).toString("base64");
const found = cases.map((values) => {
  run.shown = () => shown;
  let result = run.compute(values);
  const times = [];
  for (let k = 1; k < repeat; k += 1) {
    result = run.compute(values);
    times.push(result.milliseconds);
  }
  const { end, words, tables, branch, milliseconds } = result;
  const other = shown && result.modes[shown.run]?.[shown.name];
  const columnsOf = (of) => (of?.columns ?? []).map(({ table, label, values: column, rounding }) => ({ table, label, values: bits(column), rounding }));
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
    tables: (tables ?? []).map(({ name, rows, columns, status }) => ({ name, rows, status, why: columns.map(({ why }) => why ?? null), exact: columns.map(({ exact }) => bits(exact) ?? null) })),
    columns: columnsOf(branch), other: columnsOf(other),
    poses: branch ? [...branch.poses.values].map((x) => Number(x)) : [],
    arrows: (branch?.arrows ?? []).map(({ name, place, values }) => ({ name, place, values: bits(values) })),
    drawn: branch ? drawnWith(data, data.live.drawing, run.numbers) : {},
  };
});
process.stdout.write(JSON.stringify(found));
