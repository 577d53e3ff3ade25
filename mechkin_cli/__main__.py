"""`python -m mechkin_cli`: the same as the command `mechkin`."""

from mechkin_cli.cli.main import program

program()
