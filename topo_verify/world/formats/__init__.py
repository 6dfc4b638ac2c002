"""The file formats of worlds, one module each.

- `world_json`: the project's own format, World JSON, and its JSON Schema `world.schema.json`
- `planar_code`: plantri's binary format, for simple planar worlds, both ways
- `nx`: NetworkX: every world and planar embeddings both ways, any graph with positions
- `node_link`: NetworkX's node-link JSON, every world both ways
- `graphml`: GraphML, every world both ways, and street networks with positions (OSMnx)
- `sumo`: street networks with positions, `.net.xml`
- `rotated`: makes a world of a graph whose attributes carry the rotation: nx, node_link, graphml
- `embedding`: makes a world of vertices and edges with coordinates: nx, graphml, sumo
- `markup`: reads XML that may be hostile
- `files`: reads files up to a limit, writes them whole or not at all; every format uses it

Which format a file has: `topo_verify.world.io`.
"""
