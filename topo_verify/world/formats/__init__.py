"""The file formats of worlds, one module each.

- `world_json`: the project's own format, World JSON, and its JSON Schema `world.schema.json`
- `planar_code`: plantri's binary format, for simple planar worlds, both ways
- `nx`: NetworkX: planar embeddings both ways, any graph with positions
- `graphml`, `sumo`: street networks with positions, GraphML (OSMnx) and `.net.xml`
- `embedding`: makes a world of vertices and edges with coordinates; the last three use it
- `markup`: reads XML that may be hostile
- `files`: reads files up to a limit, writes them whole or not at all; every format uses it

Which format a file has: `topo_verify.world.io`.
"""
