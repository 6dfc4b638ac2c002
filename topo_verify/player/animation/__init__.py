"""A short run as one animated SVG. This part of the room is imported late: it draws.

film.py      the picture: what is shown and what moves, as keyframes of CSS
tracks.py    where things lie, and when
captions.py  what a moment means, in a sentence
"""

from topo_verify.player.animation.film import MOST_EVENTS, animated_svg, times

__all__ = ["MOST_EVENTS", "animated_svg", "times"]
