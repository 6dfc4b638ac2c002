"""A short run as one animated SVG.

options.py  the option --svg of `explore`
film.py     the picture: what is shown and what moves, as keyframes of CSS; its captions
tracks.py   where things lie, and when
"""
