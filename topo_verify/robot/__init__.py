"""The robot: what it senses, what happens to it, and the simulator that plays it."""
