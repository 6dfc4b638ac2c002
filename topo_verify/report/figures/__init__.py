"""The paper's figures for readers. `pictures.py` loads matplotlib, so it is imported late.

pictures.py   a figure as SVG and PNG
words.py      the paragraph under a figure: what agrees, and what does not follow from the text;
              all pictures and paragraphs as one Markdown file
"""
