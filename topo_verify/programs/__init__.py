"""A mapper in another process: the pipe to it, its end, and what it says. Nothing here judges.

protocol.py   protocol 1 and the batch format: every message as a type, and its JSON Schema
child.py      a program as a child process: its lines in and out, and its end
reaper.py     ends programs whose parent was killed
program.py    a program behind protocol 1 as a mapper, called with a robot
loading.py    a mapper found by module:attribute or file.py:attribute
serve.py      a Python mapper behind protocol 1
"""
