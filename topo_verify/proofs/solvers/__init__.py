"""Z3 and cvc5: a question in, one of three answers out."""
