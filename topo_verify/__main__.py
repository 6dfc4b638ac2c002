"""`python -m topo_verify`: the same as `topo-verify`."""

from topo_verify.cli import main

if __name__ == "__main__":
    main()
