"""The browser of the player's tests, for pages that hold players."""

from tests.player.conftest import browser, show

__all__ = ["browser", "show"]
