"""Interpreter: program tree and answers -> function blocks, as a generator that is pulled ahead."""
