"""The words of `mechkin vibrate`, as `commands.py` has those of the others."""

from __future__ import annotations

from mechkin_cli.cli.words import FILE, JSON, QUIET, SET, Command, Word

VIBRATE = Command(
    "vibrate",
    "vibrate:vibrate",
    """Find natural frequencies, mode shapes and matrices of small motions about a row of a run.

    Writes tables (CSV, SI units) into out/STEM, or a folder of your choice: frequencies, shapes,
    mass, damping and stiffness; with --input or --output the state space A, B, C, D; with
    --frequencies the response to a harmonic input, with its picture.
    """,
    (
        FILE,
        Word(
            "run",
            "Run whose row is meant (default: the first equilibria, else the first run).",
            ("--run",),
            "text",
            "NAME",
            offers="run_names",
        ),
        Word("row", "The row, counted from 0.", ("--row",), "whole", "N", default=0),
        Word(
            "coordinates",
            "Coordinates that name the motion, separated by commas (default: the free inputs, or "
            "those of the start).",
            ("--coordinates",),
            "text",
            "NAMES",
            repeated=True,
        ),
        Word(
            "hold",
            "Inputs of a sweep that stay driven, separated by commas.",
            ("--hold",),
            "text",
            "NAMES",
            repeated=True,
            offers="input_names",
        ),
        Word(
            "input_",
            "What acts: coordinates, P.position.z, driven coordinates, separated by commas.",
            ("--input",),
            "text",
            "NAMES",
            repeated=True,
        ),
        Word(
            "output",
            "Quantities and expressions that are read, separated by commas.",
            ("--output",),
            "text",
            "NAMES",
            repeated=True,
        ),
        Word(
            "frequencies",
            "Frequencies of a harmonic input, Hz, as 0.1:100:400.",
            ("--frequencies",),
            "text",
            "FROM:TO:COUNT",
        ),
        Word("view", "Write a page, too, in which the modes are played.", ("--view",)),
        Word("out", "Folder to write to.", ("-o", "--out"), "path", "FOLDER"),
        SET,
        JSON,
        QUIET,
    ),
)
