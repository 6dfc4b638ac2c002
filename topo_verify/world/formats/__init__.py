"""The file formats of worlds, one module each; `world/io.py` chooses by the file's name.

`rotated` and `embedding` make worlds of graphs with rotations and of drawings; `markup` and `files`
read what may be hostile or too large. `name` and `source` name the input in messages; a world
without a name is called `stem`.
"""
