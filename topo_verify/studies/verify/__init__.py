"""The main job: six parts, each with its own verdict; for a mapper of the user's, four of them.

verify.py        the parts, their sizes, and their worlds
parts.py         the result of a part; the parts `counts` and `proofs`
trials.py        the parts that run mappers in worlds
by_claim.py      a verdict for each claim, for the pytest plugin
"""
