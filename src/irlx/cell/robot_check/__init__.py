"""What is missing or odd in a URDF, however broken it is."""
