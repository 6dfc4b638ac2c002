"""What runs several rooms and makes one report.

verify.py    the main job: which parts, in which sizes
counts.py    the part that counts worlds
generated.py the worlds of the part that draws them by strategies
trials.py    the parts that run mappers in worlds
parts.py     what a part says when it is done
"""
