"""The main job: six parts, each with its own verdict; for a mapper of the user's, four of them.

verify.py        the parts and their sizes
parts.py         the result of a part, and the protocol of its job
counts.py        the part that compares the numbers of worlds with formulas
small_worlds.py  the part that searches all small worlds
proofs.py        the part that proves theorems
trials.py        the parts that run mappers in given worlds
generated.py     the worlds of the part that draws by strategies
by_claim.py      a verdict for each claim, for the pytest plugin
"""
