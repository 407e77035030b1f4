"""Evacuation routes: which segments fallen furniture may block, what they cut off, and what to fix.

::

    inventory -> reach (what can lie on which segment) -> evaluate (with how the pieces fall) -> Routes
"""
