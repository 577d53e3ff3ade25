"""Milliseconds that a changed dimension takes in the pages of the mechanisms kept here.

Run as `python -P tests/view/pace.py [NAME...]`. For each page that computes it prints what one
change takes: all rows and table columns, and then the picture, curves and tables that follow, in a
browser that does not draw in three dimensions. Medians; and the least, which other work of the
machine touches last. It ends with 1 where the computing of a change takes more than `BUDGET`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from references import FILE_OF, SWEPT
from view.browser import NO_GL, Browser, missing

import mechkin_cli as mk

BUDGET = 8.0
"""Milliseconds: half of a picture of sixty in a second."""

# a little more of one parameter after the other, so that nothing is known already
CHANGES = """(async () => {
  const { dimensions } = window.mechkin;
  if (!dimensions?.parameters.length) return null;
  const { own, run } = dimensions, names = Object.keys(own), computed = [], all = [];
  for (let k = 0; k < 40; k += 1) {
    const name = names[k % names.length];
    const values = { ...own, [name]: own[name] + (own[name] || 1) * 1e-7 * (k + 1) };
    const start = performance.now();
    const found = run.compute(values);
    const middle = performance.now();
    if (found.end !== 'complete') continue;
    dimensions.show(found);
    if (k < 8) continue; // until the browser has compiled what it runs
    computed.push(middle - start);
    all.push(performance.now() - start);
    await new Promise((done) => setTimeout(done, 0));
  }
  const told = (list) => list.sort((a, b) => a - b) && [list[0], list[list.length >> 1]];
  return { rows: window.mechkin.state.branch.rows, computed: told(computed), all: told(all) };
})()"""


def main(names: list[str]) -> int:
    if reason := missing():
        print(f"no page is measured: {reason}")
        return 1
    browser, slow = Browser(NO_GL), []
    print(f"{'':30} rows  computed: least median  with what follows: least median")
    with TemporaryDirectory() as folder:
        for name in names or [path.stem for path in SWEPT]:
            browser.open(mk.load(FILE_OF[name]).view(Path(folder) / "page.html", modes=False))
            found = browser.evaluate(CHANGES)
            if found is None or not found["computed"][1:]:
                continue
            least, median = found["computed"]
            print(
                f"{name:30} {found['rows']:4} {least:15.2f} {median:6.2f} "
                f"{found['all'][0]:24.2f} {found['all'][1]:6.2f}",
                flush=True,
            )
            if least > BUDGET:
                slow.append(name)
    browser.close()
    print(f"more than {BUDGET:g} ms: {', '.join(slow) or 'none'}")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
