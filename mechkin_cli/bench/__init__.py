"""`mechkin bench`: run time against error, for any mechanism file.

A *scene* is a mechanism whose rows are closed; a *method* is a way to its answers at one setting,
made by a family (`runs.FAMILIES`); a *measurement* is its time and its errors against the rows
repeated in double-double. `runs` puts them together and judges hard mechanisms
whose rows are known; `report` writes them. Only `mechkin bench` loads the chapters.
"""

from mechkin_cli.lazy import TYPE_CHECKING, lazy_names

if TYPE_CHECKING:
    from mechkin_cli.bench.measurement import *
    from mechkin_cli.bench.report import *
    from mechkin_cli.bench.runs import *
    from mechkin_cli.bench.scene import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "measurement": "Bench",
        "report": "NAMES ReportTable bench_table key_of machine plain_text record write",
        "runs": "FULL QUICK Rounds SUITE Suite bench judge_hard_mechanisms stress_table",
        "scene": "BenchScene",
    },
)
