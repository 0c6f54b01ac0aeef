"""The language: source text to typed tree, symbols and diagnostics."""
