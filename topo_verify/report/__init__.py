"""The result of a command, in each form in which people and machines read it.

blocks.py     what a command says, without a form; tones of verdicts, the palette
terminal.py, markdown.py, html.py   blocks in one form each
account.py    what was judged, how much of it, and the counterexamples to show
page.py, junit.py, badge.py         an account in one form each
csv_table.py  rows as CSV
"""
