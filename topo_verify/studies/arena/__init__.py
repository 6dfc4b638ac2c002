"""The arena: mappers in named suites of worlds, ranked by cost if every claim holds."""
