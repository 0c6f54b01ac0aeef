"""The command line: one module a command; importing them loads no numeric library."""
