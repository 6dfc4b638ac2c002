"""A mapper in another process: the pipe to it, its messages, and its end. Nothing here judges.

protocol.py         protocol 1 and the batch format: every message as a type, and its JSON Schema
child.py            a program as a child process: its lines in and out, and its end
process.py          its processor, how it ended, and what it writes on standard error
reaper.py           kills the programs whose parent was killed
isolation.py        keeps worlds from other processes; starts Python processes of our own
launcher.py         starts those that no other program can look into, not even at first
program.py          a program behind protocol 1 as a mapper, called with a robot
misbehaviour.py     what a program does instead of delivering a map
loader.py           a mapper by module:attribute or file.py:attribute; functions that numba compiles
library.py          a native mapper: a function of a shared library; topo_verify.h
delivery.py         calls a mapper and reads what it returns
serve.py            a Python mapper behind protocol 1; each world in its own fork, if asked
foreign.py          a user's Python mapper, in its own process
loaded.py           the files and distributions that a mapper's process has loaded; its values
"""
