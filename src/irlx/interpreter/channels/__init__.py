"""What a program reads and writes: files inside a folder, and the standard channels."""
