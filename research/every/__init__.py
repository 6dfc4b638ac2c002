"""Every choice of an algorithm without memory, by a compiled model of it.

kernel.py   the states of a world by masks of darts
best.py     a cheapest and a most expensive run, from the kernel's tables
table.py    a world as the kernel takes it, and the kernel's result
"""
