"""Robots: plain description (joints, limits, frame tree) and the kinematic model built from it."""
