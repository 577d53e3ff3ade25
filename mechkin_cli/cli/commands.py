"""The commands: their words, as the plain parser reads them and typer's help tells them.

Nothing is imported here that a command needs: a command names the function that does it, which is
loaded when it is called.
"""

from __future__ import annotations

from mechkin_cli.cli.vibrate_words import VIBRATE
from mechkin_cli.cli.words import (
    FILE,
    FILES,
    JSON,
    MESSAGES,
    MODE,
    QUIET,
    SET,
    TABLE,
    Command,
    Word,
)


def all_formats() -> str:
    """The formats of results in words."""
    from mechkin_cli.tables import WRITERS

    *names, last = WRITERS
    return f"{', '.join(names)} or {last}"


NEW = Command(
    "new",
    "new:new",
    """Write a commented mechanism file that runs, to start from.

    An existing file is never written over.
    """,
    (
        Word("name", "The file to write; .yaml is added.", kind="text", metavar="NAME"),
        Word(
            "template",
            "Template to start from; --list names them.",
            ("--template",),
            "text",
            "TEMPLATE",
            default="four-bar",
        ),
        Word("list_", "List the templates.", ("--list",)),
    ),
    has_model=False,
)
IMPORT = Command(
    "import",
    "bridges:import_",
    """Write the mechanism file that a file of another program becomes.

    FILE.csv is a table of hard points (name, x, y, z) for a template; FILE.urdf is a robot
    (URDF), FILE.xml a model of MuJoCo (MJCF). What cannot be carried over is named. An existing
    file is never written over.
    """,
    (
        Word("file", "The file to import.", kind="path", metavar="FILE", required=True),
        Word(
            "out",
            "File to write (default: STEM.yaml in this folder).",
            ("-o", "--out"),
            "path",
            "FILE",
        ),
        Word(
            "template",
            "Of hard points: a template of mechkin new, or a mechanism file, that takes them.",
            ("--template",),
            "text",
            "TEMPLATE",
        ),
        Word("unit", "Unit of the table's lengths, such as mm.", ("--unit",), "text", "UNIT"),
        Word(
            "rename",
            "A point of the table and what the template calls it, as 'LCA outer=lower_ball'; "
            "repeatable.",
            ("--rename",),
            "text",
            "TABLE=TEMPLATE",
            repeated=True,
        ),
        Word(
            "close",
            "Two links of a URDF whose origins a ball joins, as tip:bar, or tip:bar:R for a hinge "
            "about their z axes; repeatable.",
            ("--close",),
            "text",
            "LINKS",
            repeated=True,
        ),
        MESSAGES,
        QUIET,
    ),
)
ANALYZE = Command(
    "analyze",
    "analyze:analyze",
    """Run sweeps and responses; show and write their tables.

    Tables go to stdout and to files in out/STEM, messages to stderr. With --json no files are
    written, unless --out or --format asks for them. The exit code is 4 if rows are missing.
    """,
    (
        FILES,
        Word("out", "Folder to write to (default: out/STEM).", ("-o", "--out"), "folder", "DIR"),
        Word(
            "format",
            "{formats}; several as csv,md.",
            ("--format",),
            "text",
            "FORMAT",
            repeated=True,
            offers="format_names",
        ),
        Word("units", "Write units into CSV headers: theta [deg].", ("--units",)),
        Word(
            "decimal",
            "Mark of numbers in CSV, Markdown, LaTeX: point, or comma; CSV then has semicolons.",
            ("--decimal",),
            "text",
            "MARK",
            default="point",
        ),
        SET,
        MODE,
        TABLE,
        Word(
            "columns",
            "Only columns of these labels, as theta4,torque; may be repeated.",
            ("--columns",),
            "text",
            "LABELS",
            repeated=True,
        ),
        Word(
            "summary_only",
            "Write no rows, only what the tables sum up: their summary:, or largest and smallest.",
            ("--summary-only",),
        ),
        Word(
            "lanes",
            "Rows computed at a time: 2, 4 or 8; 0: the most the machine can.",
            ("--lanes",),
            "whole",
            "NUMBER",
            default=0,
        ),
        Word(
            "threads",
            "Threads that split the rows; 0: all cores.",
            ("--threads",),
            "whole",
            "NUMBER",
            default=0,
        ),
        Word(
            "certify",
            "Prove a sweep's positions, and that they lie on one branch.",
            ("--certify",),
        ),
        Word(
            "strict",
            "Exit with 4 also if a row is near-singular, rank-unclear, slack, beyond a limit or at "
            "a dead centre.",
            ("--strict",),
        ),
        Word("errors", "Measure the true error of every cell; write errors.csv.", ("--errors",)),
        Word("view", "Also write view.html, a page that shows all runs in motion.", ("--view",)),
        Word("explain", "Show how the loops are solved, what is skipped and why.", ("--explain",)),
        MESSAGES,
        JSON,
        QUIET,
    ),
)
VIEW = Command(
    "view",
    "view:view",
    """Write a page that shows a mechanism in motion.

    One file of HTML that works offline: the mechanism in three dimensions along its sweep and its
    responses, in all assembly modes, with curves, tables, verdicts and notes. Of a folder, a page
    for each mechanism file in it (or in the folders in it), and index.html, which shows a card of
    each. With --live it changes with the file, shows its faults with their places, and writes
    dimensions that are set in it back into the file on request; Ctrl-C ends that.
    """,
    (
        FILE._replace(help="Mechanism file (YAML, format 1), or a folder; - reads stdin."),
        Word(
            "out",
            "File to write (default: out/STEM/view.html); of a folder, a folder (default: "
            "out/FOLDER).",
            ("-o", "--out"),
            "path",
            "PAGE",
        ),
        SET,
        MODE,
        Word(
            "run",
            "Show only this run: sweep, or the name of a response.",
            ("--run",),
            "text",
            "NAME",
            offers="run_names",
        ),
        Word("no_modes", "Leave out the other assembly modes.", ("--no-modes",)),
        Word("open_", "Also open the page in the browser.", ("--open",)),
        Word(
            "live",
            "Serve the page on this machine, open it, and follow the file while it is edited.",
            ("--live",),
        ),
        Word("no_open", "With --live: do not open the browser.", ("--no-open",)),
        MESSAGES,
        QUIET,
    ),
)
CHECK = Command(
    "check",
    "check:check",
    """Validate mechanism files; every error with its line and column.""",
    (FILES, SET, MESSAGES._replace(names=("--messages", "--format")), JSON, QUIET),
)
MODES = Command(
    "modes",
    "modes:modes",
    """List the assembly modes: the ways to put a mechanism together.""",
    (
        FILE,
        Word(
            "at",
            "Value of the input instead of the first row's; of several as O1.theta=VALUE, "
            "repeatable.",
            ("--at",),
            "text",
            "VALUE",
            repeated=True,
        ),
        Word(
            "run",
            "Take the modes at the start of this response.",
            ("--run",),
            "text",
            "NAME",
            offers="response_names",
        ),
        Word("certify", "Prove that each exists, and that no two are the same.", ("--certify",)),
        SET,
        JSON,
        QUIET,
    ),
)
RANGES = Command(
    "ranges",
    "ranges:ranges",
    """Find the range of an input in each assembly mode.

    Lists dead centres, branch points and full turns, and the circuits that the modes form.
    """,
    (
        FILE,
        Word(
            "input",
            "Input that moves (default: the first one swept).",
            ("--input",),
            "text",
            "NAME",
            offers="input_names",
        ),
        Word(
            "output",
            "Output whose own dead centres are located, too; repeatable.",
            ("--output",),
            "text",
            "NAME",
            repeated=True,
        ),
        SET,
        JSON,
        QUIET,
    ),
)
MOBILITY = Command(
    "mobility",
    "mobility:mobility",
    """Find the mobility, idle freedoms and redundant constraints.

    Compares Kutzbach's count with the true mobility. Inputs need not be declared.
    """,
    (FILE, SET, JSON, QUIET),
)
CAM = Command(
    "cam",
    "cam:cam",
    """Find the profile of a cam, and what is extreme in it.

    Of a coupling (function or table) with a `follower:`. Lists lift, pressure angle and radius of
    curvature, undercut and lift-off with their places, and writes the table (CSV), the profile
    (DXF, SVG) and the pitch curve as a `curve:` (YAML) into out/STEM, or a folder of your choice.
    """,
    (
        FILE,
        Word(
            "coupling",
            "The coupling (default: the only one with a follower).",
            ("--coupling",),
            "text",
            "NAME",
        ),
        Word(
            "points",
            "Steps of the table and the profile over a turn.",
            ("--points",),
            "whole",
            "N",
            default=360,
        ),
        Word("out", "Folder to write to.", ("-o", "--out"), "path", "FOLDER"),
        SET,
        JSON,
        QUIET,
    ),
)
PLOT = Command(
    "plot",
    "plot:plot",
    """Draw curves, coupler curves and polar diagrams of a file.

    Without --y, one picture for each table, as its `plot:` says, in out/STEM/TABLE.svg; of several
    with -o x.png in x_TABLE.png. --y takes
    labels of columns, quantities or expressions. Vectors are drawn in a plane: a point's position
    as a coupler curve, a force as a polar diagram. Needs matplotlib: pip install 'mechkin[plot]'.
    """,
    (
        FILE,
        Word(
            "x",
            "What the horizontal axis shows (default: the input or time).",
            ("--x",),
            "text",
            "NAME",
        ),
        Word(
            "y",
            "What is drawn, separated by commas; repeatable.",
            ("--y",),
            "text",
            "NAMES",
            repeated=True,
        ),
        TABLE,
        Word(
            "run",
            "Run to draw: sweep, or a response (default: the first).",
            ("--run",),
            "text",
            "NAME",
            offers="run_names",
        ),
        Word("out", "File to write: .svg, .png or .pdf.", ("-o", "--out"), "path", "PICTURE"),
        MODE,
        SET,
        QUIET,
    ),
)
TOLERANCES = Command(
    "tolerances",
    "tolerances:tolerances",
    """Find what tolerances of parameters do to quantities.

    Worst case, root sum square and samples (Monte Carlo) at every row, and what each tolerance
    contributes. Writes tolerances.csv, with a line for each row, tolerances_shares.csv, and
    tolerances.md with both.
    """,
    (
        FILE,
        Word(
            "tolerance",
            "A parameter and half its band, as P1=0.01mm, or both ends, as P1=-0.01mm,0.02mm; "
            "repeatable.",
            ("--tolerance",),
            "text",
            "NAME=BAND",
            repeated=True,
            offers="parameter_names",
        ),
        Word(
            "of",
            "Quantities, expressions or labels of columns, separated by commas (default: the "
            "columns of the first table); repeatable.",
            ("--of",),
            "text",
            "NAMES",
            repeated=True,
        ),
        Word(
            "at",
            "Only the row at this value of the input; repeatable.",
            ("--at",),
            "text",
            "VALUE",
            repeated=True,
        ),
        Word(
            "samples",
            "Variants that are drawn and run.",
            ("--samples",),
            "whole",
            "NUMBER",
            default=1024,
        ),
        Word(
            "method",
            "How they are drawn: latin, sobol or random.",
            ("--method",),
            "text",
            "METHOD",
            default="latin",
        ),
        Word("seed", "Another seed draws others.", ("--seed",), "whole", "NUMBER", default=0),
        Word(
            "distribution",
            "Within the bands: uniform, or normal with half a band as three sigma.",
            ("--distribution",),
            "text",
            "NAME",
            default="uniform",
        ),
        Word("out", "Folder to write to (default: out/STEM).", ("-o", "--out"), "folder", "DIR"),
        Word("format_", "csv or md (default: both).", ("--format",), "text", "FORMAT"),
        Word(
            "plot",
            "Also draw tolerances.svg (needs matplotlib: pip install 'mechkin[plot]').",
            ("--plot",),
        ),
        SET,
        JSON,
        QUIET,
    ),
)
EXPORT = Command(
    "export",
    "bridges:export",
    """Write a mechanism in the format of another program.

    mjcf: a model for MuJoCo, in the pose of a row, loops closed by equality constraints. gltf: an
    animated scene (GLB). dxf: links, paths and cams (needs ezdxf). loads: load cases for finite
    elements, as CSV and for CalculiX. parquet: a run as a frame (needs pyarrow).
    The files go into out/STEM or a folder of your choice; what they cannot hold is named.
    """,
    (
        FILE,
        Word(
            "to",
            "Format: mjcf, gltf, dxf, loads or parquet.",
            ("--to",),
            "text",
            "FORMAT",
        ),
        Word("out", "Folder to write to (default: out/STEM).", ("-o", "--out"), "folder", "FOLDER"),
        Word(
            "run",
            "Run to export: sweep, or a response (default: the first).",
            ("--run",),
            "text",
            "NAME",
            offers="run_names",
        ),
        Word(
            "row",
            "Number of a row, from 1 on; several as 1,19 (default: the first, or all).",
            ("--row",),
            "text",
            "NUMBER",
            repeated=True,
        ),
        SET,
        MODE,
        MESSAGES,
        QUIET,
    ),
)
STUDY = Command(
    "study",
    "study:study",
    """Run many variants of a mechanism and keep a few numbers of each.

    Writes variants.csv, with a line for each variant, into a folder. A study that was stopped is
    continued by the same command. Jobs of an array each compute a share with --part I/N; --merge
    puts the shares together.
    """,
    (
        Word(
            "file",
            "Study file (YAML).",
            kind="path",
            metavar="STUDY",
            required=True,
            offers="study_files",
        ),
        Word(
            "out", "Folder to write to (default: out/STUDY).", ("-o", "--out"), "folder", "FOLDER"
        ),
        SET,
        Word(
            "format_",
            "csv or parquet.",
            ("--format",),
            "text",
            "FORMAT",
            default="csv",
            offers="study_format_names",
        ),
        Word("again", "Discard the results in the folder and start over.", ("--again",)),
        Word(
            "threads",
            "Threads of each process (0: as many as pay).",
            ("--threads",),
            "whole",
            "NUMBER",
            default=0,
        ),
        Word(
            "processes",
            "Number of new processes (0: compute in this one).",
            ("--processes",),
            "whole",
            "NUMBER",
            default=0,
        ),
        Word(
            "scheduler",
            "Compute on a Dask cluster at this address, as tcp://host:8786.",
            ("--scheduler",),
            "text",
            "ADDRESS",
        ),
        Word(
            "part",
            "Compute only the I-th of N shares, into part-I-of-N in the folder.",
            ("--part",),
            "text",
            "I/N",
        ),
        Word("merge", "Put all shares in the folder together; compute nothing.", ("--merge",)),
        Word("explain", "Estimate time and size from a trial; write nothing.", ("--explain",)),
        Word("dry_run", "Check the study and show variants; compute nothing.", ("--dry-run",)),
        JSON,
        MESSAGES,
        QUIET,
    ),
)
TABLES = Command(
    "tables",
    "tables:tables",
    """Regenerate the tables kept beside mechanism files.

    Writes the tables of FOLDER/STEM.yaml to FOLDER/STEM/TABLE.csv and .md, and a small picture to
    FOLDER/STEM/picture.svg. If tables name printed values, FOLDER/STEM/errata.md compares them and
    disagreements.csv lists every printed cell that does not agree. What mechkin wrote for a table
    that the file no longer has is removed; other files stay. A folder without mechanism files of
    its own stands for those of the folders in it. FOLDER/README.md is an overview of its
    mechanisms; a README.md of your own is left alone.
    """,
    (
        Word(
            "path",
            "A mechanism file, or a folder of them or of such folders.",
            kind="path",
            metavar="PATH",
            default="mechanisms",
            offers="mechanism_files",
        ),
        Word("check", "Compare with the tables on disk; write nothing.", ("--check",)),
        Word("against", "List printed cells that do not agree; write nothing.", ("--against",)),
        MESSAGES,
        JSON,
        QUIET,
    ),
)
SCHEMA = Command(
    "schema",
    "new:schema",
    """Print the JSON Schema of mechanism files.""",
    (
        Word("out", "Write to a file instead of stdout.", ("-o", "--out"), "path", "FILE"),
        Word("check", "Compare with the files in schemas/ (or --out) instead.", ("--check",)),
        Word("study", "Print the schema of study files instead.", ("--study",)),
    ),
    has_model=False,
)
BENCH = Command(
    "bench",
    "bench:bench",
    """Measure run time against error.

    Beside mechkin's own settings it measures scipy (pip install 'mechkin[bench]'), the dense
    systems of the sources, and explicit stepping. Without files it measures some of the templates.
    With --stress it runs a small set of hard mechanisms instead, whose rows are known, and judges
    every row.
    """,
    (
        Word(
            "files",
            "Mechanism files to measure instead of some templates.",
            kind="path",
            metavar="FILE",
            repeated=True,
        ),
        Word("quick", "Fewer rounds: takes seconds, with less accurate times.", ("--quick",)),
        Word(
            "out",
            "Also write bench.json, bench.csv, bench.md, bench.svg.",
            ("-o", "--out"),
            "folder",
            "DIR",
        ),
        JSON,
        Word("stress", "Run hard mechanisms with known rows instead.", ("--stress",)),
    ),
)

COMMANDS = {
    command.name: command
    for command in (
        *(NEW, IMPORT, ANALYZE, VIEW, CHECK, MODES, RANGES, MOBILITY, VIBRATE, CAM),
        *(PLOT, EXPORT, STUDY, TOLERANCES, TABLES, SCHEMA, BENCH),
    )
}
"""The commands by name, in the order of help."""
