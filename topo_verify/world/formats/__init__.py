"""The file formats of worlds, one module each; `world/io.py` chooses by the file's name.

- `world_json`: World JSON, the project's own format
- `planar_code`: plantri's binary format
- `nx`, `node_link`: NetworkX's graphs and its JSON
- `graphml`, `sumo`: street networks
- `rotated`: worlds of graphs whose attributes carry the rotation
- `embedding`: worlds of vertices and edges with coordinates
- `markup`: reads XML that may be hostile
- `files`: reads up to a limit, writes whole or not at all

`name` and `source` name the input in messages; a world without a name is called `stem`.
"""
