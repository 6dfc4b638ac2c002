"""Certificates of logs for Coq, and a second opinion by the judge that is proved in Coq.

certificates.py        makes certificates for logs, and has Coq check them
certificate_format.py  writes and reads certificates
evidence.py            folds a log, and records its merges
judge.py               has the extracted judge judge a trace
study.py               certificates made of logs, or received
options.py             the options that `certify` and `replay` get
certify.py             what they do in `certify`
replay.py              what --kernel does in `replay`
"""
