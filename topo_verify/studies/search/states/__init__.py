"""Every choice that a policy can make, searched as a model checker does: over states.

script.py   makes the choices of one run
memory.py   what a mapper and its judge remember: a state
graph.py    the states of a world, and runs of the mapper on which each choice lies
every.py    all choices in one world
"""
