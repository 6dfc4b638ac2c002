"""Checks an implementation, in any language, against the reference.

conform.py   the campaign; the result on each of the four levels; the transcript
likeness.py  the first decision that differs from the reference's
batch.py     a backend for a program with its own simulator
"""
