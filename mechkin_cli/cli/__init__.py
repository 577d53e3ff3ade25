"""The command line: one file per command; each parses, calls the Python interface, prints, exits.

Data goes to stdout, messages to stderr. Nothing heavy is imported before a command needs it.
"""
