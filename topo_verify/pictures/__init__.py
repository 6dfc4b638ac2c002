"""A world or a run to look at; what a mapper says stands beside the checkers' replay.

It takes a world, a trace and judgements, never a result of a campaign.

drawing/       worlds, with the true cyclic order; each picture is read back
scenes.py      what each event means: the model that every view shows
detours.py     what several moves show together: turns, ways home, circles, tests
fold_places.py where a fold identifies visits
narrator.py    what each event means, in sentences
remarks.py     what the replay adds to an event; names of darts, doors and percepts
walk.py        the run as text, S beside the truth
cards.py       reports and findings as HTML, for notebooks
recording.py   a run as compact data for the page
page.py        the page, from the parts in page/
"""
