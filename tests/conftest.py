"""What every test runs under: the Hypothesis profile, named by HYPOTHESIS_PROFILE.

`ci` (the default) tries the same examples on every machine and every run, so that a red test is
red for everyone; no deadline, because a slow machine is no fault of the code. `nightly` looks in
new places each time and for longer, and keeps what it found in Hypothesis's example database.
"""

import os

from hypothesis import HealthCheck, settings

settings.register_profile(
    "ci",
    derandomize=True,
    deadline=None,
    print_blob=True,
    # How fast examples are made depends on the machine and on coverage, not on the code's worth.
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "nightly",
    max_examples=5_000,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))
