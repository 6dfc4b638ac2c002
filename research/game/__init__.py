"""Games of robot against world on all worlds with a few edges: the cost of the best robot."""
