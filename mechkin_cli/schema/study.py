"""A study file: a mechanism, its variations, and the results of every variant."""

from typing import Annotated, Any, ClassVar, Literal

from mechkin_cli.schema.base import (
    NOTHING,
    FormChoice,
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    Spaced,
    each_once,
    refuse,
)
from mechkin_cli.schema.scalars import AnyDimension, CsvPath, Name, RunName, Text, WholeNumber
from mechkin_cli.schema.validation import validated

MechanismPath = Annotated[
    str,
    Limits(min_length=1),
    Shown(("string",), "a mechanism file, relative to the study file", ("../rcsr.yaml",)),
    SchemaName("MechanismPath"),
]

ListOfValues = Annotated[tuple[AnyDimension, ...], Limits(min_length=1)]


class RangeOfValues(Spaced):
    """Values from one to another in equal steps."""

    tag = "(range)"
    counted = "values"

    first: AnyDimension
    """First value."""
    last: AnyDimension
    """Value that the last reaches or stays below; with `count` it is the last."""
    step: AnyDimension | None = None
    """Distance between values, its sign does not matter; left out, `count` says it."""
    count: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of values; left out, `step` says it."""


class Uniform(Section):
    """Drawn, evenly between two values."""

    tag = "(uniform)"

    between: Annotated[tuple[AnyDimension, ...], Limits(min_length=2, max_length=2)]
    """The least and the largest value: [0.4 in, 0.6 in]."""


class Normal(Section):
    """Drawn from a normal distribution."""

    tag = "(normal)"

    deviation: AnyDimension
    """Standard deviation, larger than 0."""
    mean: AnyDimension | None = None
    """Mean; left out, the mechanism's own value."""


def _one_or_more(value: Any) -> Any:
    return value if isinstance(value, (list, tuple)) else (value,)


class Tolerance(Section):
    """Drawn about the mechanism's own value."""

    tag = "(tolerance)"

    tolerance: Annotated[
        tuple[AnyDimension, ...],
        Rule(_one_or_more, before=True),
        Limits(min_length=1, max_length=2),
        Shown(("string", "number"), "plus and minus this", is_short=True),
    ]
    """How far: one number for plus and minus, or both limits, as [-0.1 mm, 0.2 mm]."""
    distribution: Literal["uniform", "normal"] = "uniform"
    """`uniform`: evenly between the limits; `normal`: about their middle, a third of their half
    distance as standard deviation, not cut off."""


def _form(value: Any) -> str:
    if not isinstance(value, dict):
        return "(values)"
    for key, tag in (("between", "(uniform)"), ("tolerance", "(tolerance)")):
        if key in value:
            return tag
    return "(normal)" if {"mean", "deviation"} & value.keys() else "(range)"


Variation = Annotated[
    Annotated[ListOfValues, "(values)"] | RangeOfValues | Uniform | Normal | Tolerance,
    FormChoice(_form),
]

DRAWN = (Uniform, Normal, Tolerance)
"""Forms whose values are drawn, `sample:` says how."""


class Sample(Section):
    """How many values are drawn, and how."""

    count: Annotated[WholeNumber, Limits(ge=1)]
    """Number of samples."""
    method: Literal["random", "latin", "sobol"] = "random"
    """`random`: independent; `latin`: a Latin hypercube; `sobol`: a scrambled Sobol sequence."""
    seed: Annotated[WholeNumber, Limits(ge=0)] = 0
    """Other seeds draw other values, the same seed the same."""


KeptWord = Literal[
    "max", "min", "peak", "range", "mean", "rms", "value", "place_of_max", "place_of_min",
    "place_of_peak",
]  # fmt: skip


class Kept(Section):
    """A quantity, and what of its rows is kept of every variant."""

    keys: ClassVar[dict[str, str]] = {"words": "as"}

    of: AnyDimension
    """A quantity or expression, one number in every row."""
    words: Annotated[
        tuple[KeptWord, ...],
        Rule(_one_or_more, before=True),
        Limits(min_length=1),
        Rule(each_once),
        Shown(("string",), "one of the words: peak", is_short=True),
    ]
    """`max`, `min`, `peak` (largest magnitude), `range`, `mean`, `rms`, `place_of_max`,
    `place_of_min`, `place_of_peak` (where along the run), or `value` with `at`."""
    at: AnyDimension | None = None
    """For `value`: where along the run, a row's value of its first input that moves, or time. It
    needs it."""
    label: Text | None = None
    """Heading of the column; left out, as `peak(O1.effort)`."""

    def check(self) -> None:
        """`value` needs `at`."""
        if "value" in self.words and self.at is None:
            hint = "add at: with the input's value of a row"
            raise refuse("missing-key", "value needs a place", hint)
        if "value" not in self.words and self.at is not None:
            raise refuse("needless-key", "at goes with as: value", "remove at:", "at")


def _study_number(value: Any) -> Any:
    if str(value).strip() == "1" and not isinstance(value, bool):
        return 1
    raise refuse("unknown-format", "this version of mechkin reads studies of form 1", "study: 1")


class StudyFile(Section):
    """Many variants of a mechanism: what varies, which run, and what is kept of each.

    Lists and ranges are crossed, each of their combinations with every line of `table:` and every
    sample of what is drawn.
    """

    study: Annotated[Literal[1], Rule(_study_number, before=True)]
    """Version of the form of studies."""
    mechanism: MechanismPath | None = None
    """The mechanism file; left out, the one that Python gives."""
    name: Text | None = None
    """Name of the study; left out, that of its file."""
    run: RunName | None = None
    """The run of the mechanism, `sweep` or the name of a response; left out, its first."""
    set: dict[Name, AnyDimension] = NOTHING
    """Parameters that have another value in all variants; left out, none."""
    vary: dict[Name, Variation] = NOTHING
    """What varies: a list, a range {from, to, step | count}, or values that are drawn: {between},
    {mean, deviation}, {tolerance}; left out, what `table` has."""
    lists: Literal["crossed", "together"] = "crossed"
    """`crossed`: every value of a list with every value of the others; `together`: the first values
    of all, then the second of all."""
    table: CsvPath | None = None
    """A CSV file with names of parameters in its first line, and values of variants below; left
    out, none."""
    sample: Sample | None = None
    """How many values are drawn, and how; left out, nothing is drawn."""
    keep: tuple[Kept, ...] = ()
    """What is kept of every variant; left out, its verdict."""
    rows: tuple[AnyDimension, ...] = ()
    """Quantities of which all rows are kept, too, in files of their own; left out, none."""
    dead_centres: Literal["place"] | None = None
    """`place`: where the branch ends is found of every variant that does not reach its last row;
    left out, it is not looked for."""

    def check(self) -> None:
        """Something varies, something is kept, and what is drawn is counted."""
        drawn = [name for name, form in self.vary.items() if isinstance(form, DRAWN)]
        if not self.vary and self.table is None:
            hint = "add vary: {P1: [0.5, 0.6]} or table:"
            raise refuse("nothing-varies", "the study varies nothing", hint)
        if drawn and self.sample is None:
            hint = "add sample: {count: 1000}"
            raise refuse("missing-key", f"values of {drawn[0]} are drawn: how many?", hint)
        if self.sample is not None and not drawn:
            hint = "remove sample:, or write {between: [...]}, {mean, deviation} or {tolerance}"
            raise refuse("needless-key", "nothing in vary: is drawn", hint, "sample")


def validate_study(data: object) -> StudyFile:
    """The study that plain data describes; raises `InvalidDataError`."""
    return validated(StudyFile, data)
