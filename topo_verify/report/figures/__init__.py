"""The paper's figures for readers. `pictures.py` loads matplotlib, so it is imported late.

names.py      the names of lines, short enough for a label or the head of a column
pictures.py   a figure as SVG and PNG
words.py      the paragraph under a figure: what agrees, and what does not follow from the text
page.py       all pictures and paragraphs as one Markdown file
"""
