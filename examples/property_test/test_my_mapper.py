from hypothesis import given
from my_mapper import explore

import topo_verify as tv


@given(world=tv.strategies.worlds(max_edges=30))
def test_my_mapper_maps_every_world(world: tv.World) -> None:
    # By default a run has 5 s between moves, 60 s in all, and the moves of claim 7.
    tv.assert_maps(explore, world)
