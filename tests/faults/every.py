"""All seeded faults: those of the package, and those that only its tests need."""

from __future__ import annotations

from tests.faults import harmless, report
from topo_verify.faults import FAULTS, Fault

EVERY: dict[str, Fault] = FAULTS | {
    fault.name: fault
    for module in (report, harmless)
    for fault in vars(module).values()
    if isinstance(fault, Fault)
}

HARMLESS = {name: fault for name, fault in EVERY.items() if fault.claim is None}
"""Differences that no check may report."""
