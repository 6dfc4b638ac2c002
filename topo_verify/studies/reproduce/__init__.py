"""The paper's experiments run again: figures and their points."""
