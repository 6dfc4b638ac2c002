"""Every choice that a policy can make, searched as a model checker does: over states.

script.py    one run of a mapper that is told its choices one by one
memory.py    when two moments of two runs are the same state
graph.py     the reference: the states of a world and the choices between them, for every rule
every.py     a search's runs in one world, and the range of its costs
kernel.py    a faster, compiled model for rules without memory; tests compare it with graph.py
best.py      a cheapest and a most expensive run, from the kernel's tables
table.py     a world as the kernel takes it, and the kernel's result
"""
