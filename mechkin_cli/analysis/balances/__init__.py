"""Balances over the rows of a sweep: work over a cycle, harmonics, flywheels, the energy ledger."""
