from hypothesis import given
from mapper import explore

import topo_verify as tv


@given(world=tv.strategies.worlds(max_edges=30))
def test_the_mapper_maps_every_world(world: tv.World) -> None:
    tv.assert_maps(explore, world)
