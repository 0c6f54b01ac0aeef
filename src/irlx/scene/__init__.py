"""What stands around a robot: obstacles as plain data, and how far the robot is from them."""
