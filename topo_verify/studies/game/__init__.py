"""Games of robot against world on all worlds with a few edges: what the best robot pays.

values.py        the games, and their values
search.py        the value of a game, by search over its states
proof_game.py    the history has to prove the map among worlds of any size: states are folds
class_game.py    … among the worlds of a finite class: states are the worlds that are left
endings.py       whether a fold leaves one world: of all, of those with n vertices, of the planar
folds.py         folds as values
drawn.py         a world of the game, and lower bounds on what is to come in it
mapper_costs.py  what the catalogue pays in the same worlds
"""
