"""The folder of the campaign's tests, and few worlds run again."""

from tests.campaign.conftest import few_worlds_run_again, folder

__all__ = ["few_worlds_run_again", "folder"]
