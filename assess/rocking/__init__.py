"""One rigid block: its geometry and its equation of motion.

In: breadth, height, restitution, friction (SI), and accelerations of the floor it stands on.
Out: whether it overturns, its largest angle, when it first lifts and hits; `ensemble` for many blocks under many
motions. `block` holds eq. 4, `kernel` eqs. 1 to 3 compiled; `slip`, `sliding` and `planar` what leaves the assumption
of no slip.
May import: units, errors, progress. Knows no method, no floor and no file.
"""
