"""Values of unknowns that fit best: searched for over many at once, then refined; alone knows
scipy.optimize, and no mechanism."""
