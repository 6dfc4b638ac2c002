"""Every choice that a policy can make, searched as a model checker does: over states.

    script.py    one run of a mapper that is told its choices one by one, as they come
    memory.py    when two moments of two runs are the same state
    graph.py     the states of a world and the choices between them; each lies on a judged run
    every.py     what a search does with a world: its runs, and the range of its costs
    kernel.py    a model, for worlds of 5 and 6 edges: rules that remember nothing, compiled
    behind.py    what may happen behind one e, for the kernel
    best.py      a cheapest and a most expensive run, read off the tables of the kernel
    table.py     a world as the kernel takes it, and what the kernel found

`best.py` loads numba and NumPy, so it is imported where it is used.

`graph.py` is the reference, for every rule; `kernel.py` is faster, and tests hold it to `graph.py`
in both costs, and in the states and choices that are left once what tells runs of the same S apart
is left out.
"""
