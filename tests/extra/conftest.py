"""The command line as its tests call it, for the tests of extras."""

from tests.cli.conftest import call, cut_off, folder, program, refused, results

__all__ = ["call", "cut_off", "folder", "program", "refused", "results"]
