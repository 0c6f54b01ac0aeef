"""How near links come to obstacles and to each other, row by row."""
