"""Evacuation routes: which segments fallen furniture could block, what they cut off, and what to fix.

::

    inventory -> obstructions (what can lie on which segment) -> evaluate (with how the pieces fall) -> RouteTables
"""
