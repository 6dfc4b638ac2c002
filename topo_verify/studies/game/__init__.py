"""Games of robot against world on all worlds with a few edges: what the best robot pays.

values.py   the games and their values; what the catalogue pays
search.py   the value of a game, by search over its states
rules.py    the states, choices and answers of two games
folds.py    folds as values
drawn.py    a world of the game, and lower bounds on the remaining cost
"""
