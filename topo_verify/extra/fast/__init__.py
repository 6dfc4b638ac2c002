"""The extra `fast`: the compiled engine, and native mappers that numba compiles.

engine.py       which mappers the engine accepts, and how it examines a campaign's shards
shard.py        a shard by the engine, judged again in part by the checkers
snapshots.py    the counts of the engine
checks.py       the judgements of the compiled judge on a trace
functions.py    `--library path/file.py:name`: a function that numba compiles
native.py       what such a function does with its robot; import it as topo_verify.native
options.py      the option --engine
kernels/        algorithms, judge and enumeration for numba, over one array of integers
"""
