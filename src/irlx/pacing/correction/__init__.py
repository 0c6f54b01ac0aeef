"""Correction of the tool pose tick by tick: a layer behind the paced rows, with joint limits of its own."""
