"""The main job: six parts with their verdicts; four of them for a user's mapper.

verify.py     the parts, their sizes and worlds
parts.py      the result of a part; `counts` and `proofs`
trials.py     the parts that run mappers
by_claim.py   a verdict for each claim, for the pytest plugin
"""
