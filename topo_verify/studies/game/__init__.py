"""Games of robot against world on all worlds with a few edges: what the best robot pays.

values.py        the games, and their values; what the catalogue pays in the same worlds
search.py        the value of a game, by search over its states
rules.py         the history has to prove the map among worlds of any size: states are folds;
                 or among those of a finite class: states are the worlds that are left
folds.py         folds as values; whether a fold leaves one world: of all, of those with n
                 vertices, of the planar
drawn.py         a world of the game, and lower bounds on what is to come in it
"""
