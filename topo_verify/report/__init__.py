"""The result of a command, in each form in which people and machines read it.

blocks.py     what a command says, without a form; tones of verdicts, the palette
terminal.py, markdown.py, html.py   blocks in one form each
account.py    what was judged, how much of it, and the counterexamples to show
page.py, junit.py, badge.py         an account in one form each
league.py     the plot of the arena
figures/      the paper's figures as pictures, with a paragraph under each
"""
