"""Fuzzing: damaged input of every kind, what has to hold whatever comes, and the campaign around both."""
