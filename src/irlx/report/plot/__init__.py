"""Curves of streams, drawn as figures and in a terminal."""
