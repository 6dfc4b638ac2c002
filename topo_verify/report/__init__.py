"""What a run leaves for readers: tables, figures and reports.

figures/   the paper's figures as pictures, and the paragraph under each; imported late
"""
