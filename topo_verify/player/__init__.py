"""A run to look at: what each event of a trace means, as text and as a page.

It takes a world, a trace and judgements, never an Exploration: what a mapper says about its own run
is shown beside the replay of the checkers, and not believed.

scenes.py    what each event means, beside the world: the model that every view shows
detours.py   what moves show when they are read together: turns, ways home, circles, tests
narrator.py  what each event means, in sentences: for the text walk, the animation and the page
remarks.py   what the replay adds to an event; names of darts, doors and percepts
walk.py      the run as text, S beside the truth
cards.py     reports and findings as HTML, for notebooks
recording.py a run as compact data for the page
fold_places.py where a fold identifies visits, and where it contradicts itself
page.py      the page: one self-contained file
page/        its parts: a template, a style sheet, small scripts; fold.js folds as the checkers do
animation/   a run as an animated SVG
"""
