"""Mappers with one mistake each, and the claim that must catch it. They test the checks.

    fault.py       what a fault is, and how a part of a reference algorithm is replaced
    motion.py, marker.py, hypotheses.py, chart.py, prefix.py, history.py, records.py, folding.py,
    declarations.py, report.py
                   the mistakes, by the part of the mapper that they are in
    harmless.py    differences that are no mistakes: no check may report them

Every fault can be named as a TARGET, as `topo_verify.faults.motion:restores_with_the_wrong_sign`.
Which check finds which, how fast and in which smallest world: `topo-verify faults`.
"""

from __future__ import annotations

from topo_verify.faults import (
    chart,
    declarations,
    folding,
    harmless,
    history,
    hypotheses,
    marker,
    motion,
    prefix,
    records,
    report,
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
        report,
        harmless,
    )
    for fault in vars(part).values()
    if isinstance(fault, Fault)
}
"""Every fault and every harmless difference under its name."""
