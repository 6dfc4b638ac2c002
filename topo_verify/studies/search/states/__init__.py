"""Every choice that a policy can make, searched as a model checker does: over states.

graph.py is the reference and runs the mapper; kernel.py is a faster, compiled model for rules
without memory. Tests compare them.
"""
