"""A run in the browser, live: the robot, the program, obstacles to be moved, and the program run again."""
