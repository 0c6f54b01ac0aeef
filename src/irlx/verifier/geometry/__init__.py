"""Geometry by the verifier's own formulas: rotations, forward kinematics, lines, arcs."""
