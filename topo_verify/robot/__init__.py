"""The robot: percepts and doors, the events of a trace, the simulator, limits for mappers."""
