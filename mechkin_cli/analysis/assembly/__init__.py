"""The assembly that a run starts from: near given coordinates, a named mode, or the drawing."""
