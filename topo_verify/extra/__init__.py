"""What only some users need, a package for each extra; topo_verify/extras.py is the door."""
