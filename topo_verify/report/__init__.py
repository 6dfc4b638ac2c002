"""What a command came to, in every form in which people and machines read it.

style.py      one style for all: the tone and mark of each verdict, the palette
blocks.py     what a command has to say: paragraphs, tables, commands to copy; of no form
terminal.py   blocks on a terminal, down to 50 columns
markdown.py   blocks as Markdown, for summaries of continuous integration
"""
