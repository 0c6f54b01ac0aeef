"""Solid shapes as plain data, of links and of obstacles, and where they lie."""
