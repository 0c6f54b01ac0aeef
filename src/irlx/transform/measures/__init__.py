"""How good a posture is for some end: one measure a module, each with its exact gradient."""
