"""The command line, one file for each command: parse, call the Python interface, print, exit.

Data goes to stdout, messages to stderr. Nothing heavy is imported before a command needs it.
"""

from __future__ import annotations
