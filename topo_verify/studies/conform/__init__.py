"""Checks an implementation, in any language, against the reference.

conform.py   the campaign, and the result on each level
outcome.py   a row on the four levels; what is noted of a run, and the transcript
likeness.py  the first decision that differs from the reference's
batch.py     a backend for a program with a simulator of its own
"""
