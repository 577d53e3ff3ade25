"""What a user asks for: the assembly at the first row, the sweep, and their results."""
