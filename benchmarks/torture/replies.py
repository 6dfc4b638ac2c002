"""A program that answers each line with the next piece of a file; its imports are fast.

python replies.py FILE
"""

import sys

with open(sys.argv[1], "rb") as file:  # noqa: PTH123  pathlib takes longer to import than this runs
    lines = file.read().splitlines(keepends=True)

heard = True
for line in lines:
    # A declaration is not answered, so the next line follows at once.
    if heard and not sys.stdin.buffer.readline():
        break
    sys.stdout.buffer.write(line)
    sys.stdout.buffer.flush()
    heard = b'"declare"' not in line
sys.stdin.buffer.read()
