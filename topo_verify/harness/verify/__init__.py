"""The main job: what can be checked in about a minute, each part with its own verdict.

verify.py        which parts, in which sizes
parts.py         what a part says when it is done
counts.py        the part that counts worlds
small_worlds.py  the part that searches all small worlds
proofs.py        the part that asks for the theorems
trials.py        the parts that run mappers in given worlds
generated.py     worlds of the part that draws them by strategies
by_claim.py      a verdict for each claim, for the pytest plugin
"""
