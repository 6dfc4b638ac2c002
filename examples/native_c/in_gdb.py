"""Runs a native mapper in one world in this process, for a debugger.

gdb -batch -ex run -ex 'bt 3' --args .venv/bin/python examples/native_c/in_gdb.py ./mapper.so m2/4
"""

import sys

import topo_verify as tv
from topo_verify.programs.loader import load

if len(sys.argv) != 3:
    sys.exit("usage: in_gdb.py LIBRARY WORLD, as ./mapper.so m2/4")
library, world = sys.argv[1:]
print(tv.explore(world, load(f"--library {library}")))
