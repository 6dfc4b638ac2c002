"""Worlds in files and out of them.

- `world_json`: the project's own format, World JSON, and its JSON Schema `world.schema.json`
- `planar_code`: plantri's binary format, for simple planar worlds, both ways
- `nx`: NetworkX: planar embeddings both ways, any graph with positions
- `graphml`, `sumo`: street networks with positions, GraphML (OSMnx) and `.net.xml`
- `drawing`: how places and ways with coordinates become a world; the last three speak it
- `markup`: XML without its dangers
- `loading`: which of the formats a file has, by its name
- `files`: reading with a limit, writing whole or not at all; every format goes through it
"""
