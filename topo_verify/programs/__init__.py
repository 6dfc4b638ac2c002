"""A mapper in another process: the pipe to it, its messages, and its end. Nothing here judges.

protocol.py   protocol 1 and the batch format: every message as a type, and its JSON Schema
child.py      a program as a child process: its lines in and out, and its end
reaper.py     kills the programs whose parent was killed
program.py    a program behind protocol 1 as a mapper, called with a robot
loader.py     a mapper by module:attribute or file.py:attribute
serve.py      a Python mapper behind protocol 1
"""
