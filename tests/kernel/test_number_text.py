"""Numbers as text against Python's shortest digits and exact decimals; CSV against `csv`."""

import csv
import io
import json
import math
from decimal import ROUND_HALF_EVEN, Context, Decimal

import numpy as np
import pytest

from mechkin_cli.kernel._kernel import (
    csv_header,
    csv_lines,
    decimal_texts,
    json_lines,
    number_text,
)

INFINITY, NAN = float("inf"), float("nan")


def csv_text(labels, columns, digits=0, size=1 << 20, **options):
    """A header and all lines, written into a room of so many bytes at a time."""
    text, row, room = csv_header(labels).encode(), 0, np.zeros(size, np.uint8)
    rows = len(columns[0][0] if isinstance(columns[0], tuple) else columns[0])
    while row < rows:
        end, pieces = csv_lines(columns, row, room, digits, **options)
        assert end > row, "no line fits"
        text += b"".join(room[start : start + count].tobytes() for start, count in pieces)
        row = end
    return text


def random_doubles(count, seed):
    random = np.random.default_rng(seed)
    any_bits = np.frombuffer(random.bytes(8 * count), dtype=np.float64)
    usual = random.uniform(-1, 1, count) * 10.0 ** random.integers(-7, 18, count)
    values = np.concatenate([any_bits, usual])
    return values[np.isfinite(values)].tolist()


def plain_or_exponent(decimal):
    """The layout rule, written with decimal: plain notation from 1e-5 up to below 1e16."""
    if Decimal("1e-5") <= abs(decimal) < Decimal("1e16"):
        text = f"{decimal:f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    digits, exponent = f"{decimal:e}".split("e")
    digits = digits.rstrip("0").rstrip(".") if "." in digits else digits
    return f"{digits}e{exponent[0]}{exponent[1:]:0>2}"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (1.0, "1"),
        (-2.0, "-2"),
        (0.1, "0.1"),
        (192.0, "192"),
        (-103.88240000000002, "-103.88240000000002"),
        (1e-5, "0.00001"),
        (9.999999999999999e-06, "9.999999999999999e-06"),
        (1e-6, "1e-06"),
        (-2.5e-300, "-2.5e-300"),
        (5e-324, "5e-324"),
        (1e15, "1000000000000000"),
        (9999999999999998.0, "9999999999999998"),
        (1e16, "1e+16"),
        (1.7976931348623157e308, "1.7976931348623157e+308"),
        (1e22, "1e+22"),
        (NAN, ""),
        (INFINITY, ""),
        (-INFINITY, ""),
    ],
)
def test_shortest(value, text):
    assert number_text(value) == text


def test_shortest_has_the_digits_of_repr():
    for value in random_doubles(3000, seed=1):
        text = number_text(value)
        assert float(text) == value
        assert text == plain_or_exponent(Decimal(repr(value)))


def test_shortest_at_all_powers_and_beside_them():
    """Of two the way to the number below is half as long; near powers of ten digits run over."""
    powers = [math.ldexp(1.0, e) for e in range(-1074, 1024)]
    powers += [float(f"{digit}e{e}") for e in range(-323, 309) for digit in (1, 5, 9)]
    values = [x for p in powers for x in (math.nextafter(p, 0.0), p, math.nextafter(p, math.inf))]
    values += [float(2**53 + k) for k in range(-5, 5)] + [k / 8 for k in range(1, 5000)]
    values = [x for x in values if x and math.isfinite(x)]
    assert len(values) > 16_000
    wrong = [x for x in values if number_text(x) != plain_or_exponent(Decimal(repr(x)))]
    assert wrong == []


@pytest.mark.parametrize("step", [4, 8, 16])
def test_ends_at_a_multiple_of_ten_belong_to_even_numbers(step):
    """Halfway to the next double stands a number with a digit less, which reads back as the even
    one of the two: no digit of a product that is cut off decides that."""
    first = 2**52 * step
    doubles, half = range(first, first + 2000 * step, step), step // 2
    values = [v for v in doubles if (v + half) % 10 == 0 or (v - half) % 10 == 0]
    assert len(values) > 100
    found = [number_text(float(v)) for v in values]
    assert found == [plain_or_exponent(Decimal(repr(float(v)))) for v in values]


@pytest.mark.parametrize("digits", [1, 6, 12, 15])
def test_significant_digits_round_the_exact_value(digits):
    context = Context(prec=digits, rounding=ROUND_HALF_EVEN)
    for value in random_doubles(1000, seed=2):
        if 1e-300 < abs(value) < 1e308:
            rounded = context.create_decimal(value)
            assert number_text(value, digits) == plain_or_exponent(rounded)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.1 + 0.2, 12, "0.3"),
        (9999999999999998.0, 12, "1e+16"),
        (9.9999999999999991e-06, 12, "0.00001"),
        (-1e-320, 12, "-1e-320"),
        (0.125, 2, "0.12"),
        (0.375, 2, "0.38"),
        (1.7976931348623157e308, 2, "1.7976931348623157e+308"),
        (-0.0, 12, "0"),
        (NAN, 12, ""),
        (-INFINITY, 12, ""),
    ],
)
def test_significant_digits(value, digits, text):
    assert number_text(value, digits) == text


@pytest.mark.parametrize("digits", [-1, 16])
def test_refused_numbers_of_digits(digits):
    with pytest.raises(ValueError, match="significant_digits"):
        number_text(1.0, digits)


def fixed_texts(values, decimals):
    return decimal_texts((values, False, decimals, False))


@pytest.mark.parametrize("decimals", [0, 1, 3, 15, 20, 22, 23, 60])
def test_fixed_rounds_the_exact_value(decimals):
    values = [v for v in random_doubles(500, seed=3) if 1e-9 < abs(v) < 1e30]
    step, context = Decimal(1).scaleb(-decimals), Context(prec=100)
    rounded = [Decimal(v).quantize(step, ROUND_HALF_EVEN, context) for v in values]
    expected = [f"{r if r else abs(r):f}" for r in rounded]
    assert fixed_texts(np.array(values), decimals) == expected


def test_fixed_of_special_values():
    values = np.array([0.0, -0.0, -0.0004, -0.0005, 2.5, NAN, INFINITY, -1e300])
    expected = ["0.000", "0.000", "0.000", "-0.001", "2.500", "", "", f"{-(10.0**300):.3f}"]
    assert fixed_texts(values, 3) == expected
    assert fixed_texts(np.array([0.5, 1.5, -0.5]), 0) == ["0", "2", "0"]


def test_fixed_of_ties_and_of_the_bounds_of_whole_arithmetic():
    """Halves of the last digit, 2^53 and 2^64 / 10^d, the least doubles: where paths change."""
    edges = [2.0**53, 2.0**64, 2.0**64 / 1000, 2.0**-75, 2.0**-76, 5e-324, 2.0**-1022, 0.5]
    near = [np.nextafter(v, way) for v in edges for way in (0.0, np.inf)]
    ties = [k * 0.125 for k in range(-17, 18)]
    values = np.array([*edges, *near, *ties])
    for decimals in (0, 1, 2, 3, 22, 25):
        step, context = Decimal(1).scaleb(-decimals), Context(prec=1200)
        rounded = [Decimal(v).quantize(step, ROUND_HALF_EVEN, context) for v in values.tolist()]
        expected = [f"{r if r else abs(r):f}" for r in rounded]
        assert fixed_texts(values, decimals) == expected


@pytest.mark.parametrize("decimals", [-1, 1001])
def test_refused_decimals(decimals):
    with pytest.raises(ValueError, match="decimals must be 0 to 1000"):
        fixed_texts(np.zeros(1), decimals)


@pytest.mark.parametrize("threads", [0, -1, 257])
def test_refused_threads(threads):
    with pytest.raises(ValueError, match="threads must be 1 to 256"):
        csv_lines([np.zeros(1)], 0, np.zeros(100, np.uint8), threads=threads)


def test_csv():
    numbers = np.array([150.0, -0.0, NAN])
    words = (np.array([1, 0, 1], dtype=np.int32), ["ok", 'lost, "branch"'])
    assert csv_text(["theta1", "a,b"], [numbers, words]) == (
        b'theta1,"a,b"\n150,"lost, ""branch"""\n0,ok\n,"lost, ""branch"""\n'
    )


def test_csv_is_read_back_by_the_csv_module():
    labels = ["plain", "with, comma", 'with "quotes"', "two\nlines", "", "θ₁"]
    texts = [*labels, "cr\rhere"]
    codes = np.arange(7, dtype=np.int32)
    columns = [np.linspace(0, 1, 7), *((codes, texts) for _ in range(5))]
    written = csv_text(labels, columns).decode()
    header, *rows = csv.reader(io.StringIO(written, newline=""))
    assert header == labels
    assert rows == [
        [number_text(x), *[text] * 5] for x, text in zip(columns[0], texts, strict=True)
    ]


def test_csv_with_significant_digits():
    columns = [np.array([1 / 3, 2.0]), np.array([NAN, 2 / 3])]
    assert csv_text(["a", "b"], columns, 12) == b"a,b\n0.333333333333,\n2,0.666666666667\n"


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_lines_do_not_depend_on_the_room(threads):
    """Rooms for one line, for some, for a part of a thread's block, and for all."""
    numbers = np.array(random_doubles(3000, 1)[:4000])
    words = (np.arange(4000, dtype=np.int32) % 3, ["ok", "", "a longer word, in quotes"])
    columns = [numbers, words, numbers[::-1].copy()]
    whole = csv_text(["a", "b", "c"], columns)
    for size in (100, 1000, 90_001, 1 << 19):
        assert csv_text(["a", "b", "c"], columns, size=size, threads=threads) == whole
    end, pieces = csv_lines(columns, 0, np.zeros(50, np.uint8), threads=threads)
    assert (end, pieces) == (0, [])


def test_a_room_is_not_written_beyond_its_end():
    """Of longest numbers: digits are copied by more bytes than a number has."""
    room = np.full(1000, 7, np.uint8)
    column = np.full(100, -1.2345678901234567e-05)
    for size in range(1, 900, 13):
        room[:] = 7
        end, pieces = csv_lines([column, column], 0, room[:size])
        assert (room[size:] == 7).all()
        assert end == sum(count for _, count in pieces) / 50


def test_the_decimal_comma_stands_in_numbers_alone():
    words = (np.array([0, 1], dtype=np.int32), ["a.b", "c;d"])
    room = np.zeros(1000, np.uint8)
    end, pieces = csv_lines([np.array([0.5, -1e-30]), words], 0, room, decimal_comma=True)
    assert end == 2
    assert room[: pieces[0][1]].tobytes() == b'0,5;a.b\n-1e-30;"c;d"\n'
    assert csv_header(["a.b", "c;d", "e,f"], True) == 'a.b;"c;d";e,f\n'


def test_lines_of_json_are_read_back_with_the_kinds_of_their_columns():
    numbers = [value for value in random_doubles(2000, 3) if value] + [NAN, INFINITY, 3.0, -0.0]
    rows = len(numbers)
    words = (np.arange(rows, dtype=np.int32) % 2, ['"ok"', '"\\u03b8"'])
    columns = [np.array(numbers), np.arange(rows, dtype=float), words]
    room = np.zeros(rows * 200, np.uint8)
    end, pieces = json_lines(['"x"', '"row"', '"word"'], columns, 0, room, [False, True, False], 2)
    assert end == rows
    text = b"".join(room[start : start + count].tobytes() for start, count in pieces).decode()
    for row, line in enumerate(text.splitlines()):
        read = json.loads(line)
        x = numbers[row]
        assert read == {
            "x": x if math.isfinite(x) else None,
            "row": row,
            "word": "okθ"[row % 2 * 2 :][: 2 - row % 2],
        }
        assert type(read["row"]) is int
        assert read["x"] is None or type(read["x"]) is float


def test_csv_of_the_longest_numbers():
    longest = np.full((20, 50), -1.2345678901234567e-05)
    text = csv_text([f"c{i}" for i in range(20)], list(longest)).decode()
    assert text.splitlines()[1:] == [",".join(["-0.000012345678901234568"] * 20)] * 50


def test_csv_without_rows():
    assert csv_text(["a", "b"], [np.empty(0), np.empty(0)]) == b"a,b\n"


@pytest.mark.parametrize(
    ("columns", "error"),
    [
        ([np.zeros(2), np.zeros(3)], "different length"),
        ([(np.array([2], dtype=np.int32), ["x", "y"])], "stands for none"),
        ([(np.array([-1], dtype=np.int32), ["x"])], "stands for none"),
        ([(np.array([0], dtype=np.int32),)], "pair"),
    ],
)
def test_refused_tables(columns, error):
    with pytest.raises(ValueError, match=error):
        csv_lines(columns, 0, np.zeros(100, np.uint8))


def test_refused_places_and_keys():
    room = np.zeros(100, np.uint8)
    with pytest.raises(ValueError, match="behind the last"):
        csv_lines([np.zeros(2)], 3, room)
    with pytest.raises(ValueError, match="one label per column"):
        json_lines([], [np.zeros(1)], 0, room, [])
    with pytest.raises(ValueError, match="whole"):
        json_lines(['"x"'], [np.zeros(1)], 0, room, [])
    with pytest.raises(TypeError):
        csv_lines([np.zeros(1)], 0, b"not to be written")
