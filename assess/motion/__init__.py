"""Ground and floor motion.

In: files of recorded motion (`formats`, one file a format), peaks, profiles of codes (`scenario`), ShakeMaps and
ground motion fields (`shakemap`, `ground_scenarios`), the building's height and structure (`beam`, `assumed`).
Out: `record.Record` (channels of acceleration, m/s2), spectra, targets, and suites of motions of a floor that fit
them (`generate`, `suite`), the same for every piece of the floor.
May import: units, errors, settings and progress. Knows no furniture, no workbook and no report.
"""
