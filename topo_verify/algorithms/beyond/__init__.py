"""Rules and mappers that are ours, not the paper's: the complete rule, and mappers that steer."""
