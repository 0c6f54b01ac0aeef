"""Random valid programs with random robots and cells, for `motions.py`: drawing, judging, making smaller."""
