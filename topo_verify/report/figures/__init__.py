"""The paper's figures: pictures.py draws them (matplotlib), words.py describes them."""
