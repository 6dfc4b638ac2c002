"""Checks an implementation, in any language, against the reference.

conform.py   tallies all worlds of a corpus, level by level
order.py     the order in which an implementation meets the worlds
outcome.py   the result in one world
likeness.py  the first decision that differs from the reference's
examiner.py  examines worlds in this process
parallel.py  worlds as tasks of the worker pool
batch.py     worlds for a program with a simulator of its own
"""
