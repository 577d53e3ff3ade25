"""`mechkin bench`: what a row costs on this machine, for RCSR and a general 7R.

Everything is measured in one run on one thread. Nothing is read but the package itself.
"""
