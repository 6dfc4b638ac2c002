"""Checks an implementation, in any language, against the reference."""
