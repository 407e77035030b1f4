"""Evacuation routes: which segments fallen furniture could block, what they cut off, and what to fix.

In: an inventory with places, segments and pieces, and how pieces fall in each draw. Out: `route_results.RouteTables`.
Way: `obstructions` (what can lie on which segment, from `geometry` and `walls`), `gaps` (what width is left),
`chances` (what falls together), `network` and `rooms` (what is cut off), `fixes` (what opens it again), `evaluate`
(all of it).
May import: `model`, `workbook` and what stands below. Knows no method: it is given falls.
"""
