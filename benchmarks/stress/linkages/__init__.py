"""Linkages with closed forms: how they are written, and what their rows are.

Each is many mechanisms at once: numbers are arrays (mechanisms, 1), places of rows (mechanisms,
rows). The numbers are those of the file, exactly.
"""
