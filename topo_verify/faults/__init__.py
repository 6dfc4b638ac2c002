"""Mappers with one mistake each, and the claim that must catch it, e.g. for property tests.

`fault.py` defines a fault, and replaces a part of a reference algorithm; every other file has the
mistakes in one part of the mapper. Each fault is a TARGET, as
`topo_verify.faults.motion:restores_with_the_wrong_sign`.
"""

from __future__ import annotations

from topo_verify.faults import (
    chart,
    declarations,
    folding,
    history,
    hypotheses,
    marker,
    motion,
    prefix,
    records,
)
from topo_verify.faults.fault import Fault

__all__ = ["FAULTS", "Fault"]

FAULTS: dict[str, Fault] = {
    fault.name: fault
    for part in (
        hypotheses,
        motion,
        marker,
        chart,
        prefix,
        history,
        records,
        folding,
        declarations,
    )
    for fault in vars(part).values()
    if isinstance(fault, Fault)
}
