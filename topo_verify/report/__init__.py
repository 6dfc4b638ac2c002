"""What a command came to, in every form in which people and machines read it.

blocks.py     what a command has to say: paragraphs, tables, commands to copy; of no form
"""
