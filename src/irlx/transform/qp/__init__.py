"""Least-norm problems with bounds on rows: the small QP left after the null-space reduction."""
