"""The functions of `topo_verify.h` for a mapper that numba compiles; see the extra `fast`.

from topo_verify import native as tv
"""

from topo_verify.extra.fast.native import *  # noqa: F403  the name that mappers import
