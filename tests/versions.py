"""What is pinned in a test may hold for some versions of a package only."""

from __future__ import annotations

from importlib import metadata


def older(package: str, *version: int) -> bool:
    """Is the installed package older than this version?"""
    numbers = metadata.version(package).split(".")[: len(version)]
    return tuple(map(int, numbers)) < version
