"""Pre-interpolator and interpolator: from a move block to a path and the programmed time on it."""
