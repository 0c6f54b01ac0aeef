"""What a redundant robot does with its freedom: one criterion a module."""
