"""A mapper in another process: the pipe to it, its messages, and its end. Nothing here judges.

protocol.py       protocol 1 and the batch format
child.py          a program as a child process
process.py        its processor, exit status and standard error
reaper.py         kills programs whose parent was killed
isolation.py      keeps worlds from other processes
launcher.py       starts processes that no other program can look into
program.py        a program behind protocol 1 as a mapper
misbehaviour.py   what a program does instead of delivering a map
loader.py         finds a mapper by its text
library.py        a native mapper; topo_verify.h
delivery.py       calls a mapper and reads its result
serve.py          a Python mapper behind protocol 1
foreign.py        a user's Python mapper in its own process
loaded.py         what results of a mapper rest on
"""
