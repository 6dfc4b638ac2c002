"""Anyone's implementation, in any language, checked against the reference."""
