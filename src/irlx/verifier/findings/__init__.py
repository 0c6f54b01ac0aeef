"""What checks find, and how it is told."""
