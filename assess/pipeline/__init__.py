"""The work: an inventory in, results out.

In: `assess.model.Inventory` and `assess.settings.Settings`; progress and cancelling in one object.
Out: `assess.results.Results`, by `run.run`; `run.compute` stops after the formulas.
Way: `demand` (what shakes each floor), `ensembles` (its motions), `verify` (pieces rocked), `adopt` (the
chance that a report shows), `anchors`, `annual` (chances a year), routes by `assess.routes`, `schedule` (what to fix
first). `levels` and `piece_fragility` sweep amplitudes; `corrected` writes corrections into a workbook; `live_values`
is what its live columns show.
May import: everything below it: `routes`, `workbook`, `methods`, `rocking`, `motion`. Knows no output format.
"""
