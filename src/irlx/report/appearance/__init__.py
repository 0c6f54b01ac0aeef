"""What a cell looks like, as plain data for those who draw it: links, joints, obstacles, their shapes."""
