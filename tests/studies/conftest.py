"""The fixtures of tests/campaign, for the studies as well."""

from __future__ import annotations

from tests.campaign.conftest import few_worlds_run_again, folder

__all__ = ["few_worlds_run_again", "folder"]
