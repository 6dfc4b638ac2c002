"""Games of robot against world on all worlds with a few edges: what the best robot pays."""
