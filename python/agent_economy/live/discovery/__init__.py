"""How other programs of this machine find the drives that run, and stop them.

A drive listens on an abstract socket (Linux), and keeps a file; `stop` looks for both.
"""
