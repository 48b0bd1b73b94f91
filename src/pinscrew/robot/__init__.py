"""A robot: its description with the screws and home poses of every frame, and the ways to one."""
