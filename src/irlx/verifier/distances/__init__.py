"""Distances between solids by the verifier's own formulas: support points, simplices, separating planes."""
