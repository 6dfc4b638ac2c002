"""A short run as one animated SVG. Import it late: it draws.

film.py    the picture: what is shown and what moves, as keyframes of CSS; its captions
tracks.py  where things lie, and when
"""

from topo_verify.pictures.animation.film import MOST_EVENTS, animated_svg, times

__all__ = ["MOST_EVENTS", "animated_svg", "times"]
