"""Slowing down on the path: a motion planned as a whole where ordinary ticks would break a bound.

Stages, each usable alone: `grid` cuts the path, `elastic_walk` finds a posture for every knot, `relax`
smooths them in the null space, `curve` joins them to q(s), `clock` finds the fastest way through it, and
`resample` turns that into rows. `planned` leads through them and judges the rows by differences.
"""
