"""What closed forms are written over: double-double rows, and their Taylor series in time."""
