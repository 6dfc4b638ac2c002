"""The file formats of worlds, one module each; `world/io.py` chooses by the file's name.

- `world_json`: World JSON, the project's own format
- `planar_code`: plantri's binary format, for simple planar worlds
- `nx`: NetworkX: rotations and planar embeddings both ways, graphs with positions
- `node_link`: NetworkX's node-link JSON
- `graphml`: GraphML, and street networks with positions (OSMnx)
- `sumo`: street networks, `.net.xml`
- `rotated`: worlds of graphs whose attributes carry the rotation
- `embedding`: worlds of vertices and edges with coordinates
- `markup`: reads XML that may be hostile
- `files`: reads up to a limit, writes whole or not at all

`decode(cls, data, name, stem)` reads, `encode(world)` writes. `name` and `source` name the input in
messages, `stem` a world without a name. What is wrong raises an `InputError` that says where.
"""
