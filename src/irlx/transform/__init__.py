"""Inverse transform: one tick of demanded tool pose -> joint vector, by compact QP in Newton-Raphson."""
