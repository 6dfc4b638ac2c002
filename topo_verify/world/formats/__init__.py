"""Worlds in files and out of them.

- `world_json`: the project's own format, World JSON, and its JSON Schema `world.schema.json`
- `files`: reading with a limit, writing whole or not at all; every format goes through it
"""
