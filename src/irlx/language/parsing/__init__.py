"""From tokens to a tree: the LALR machine and its recovery from mistakes."""
