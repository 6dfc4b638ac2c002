"""The account of a command, in every form in which people and machines read it.

blocks.py     what a command has to say, in no form yet; the tone and mark of verdicts, the palette
terminal.py   blocks on a terminal, down to 50 columns
markdown.py   blocks as Markdown, for summaries of continuous integration
html.py       blocks as HTML, text in XML
account.py    what was judged, how much of it, and the counterexamples to look at
page.py       an account as one self-contained page; its style and script lie in page/
junit.py      an account as a JUnit file
badge.py      an account as a badge
league.py     the plot of the arena
figures/      the paper's figures as pictures, and the paragraph under each; imported late
"""
