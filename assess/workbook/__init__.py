"""The workbook and the inventory that it holds.

Reading: `open` (bytes to cells), `parse` (cells to typed rows), `resolve` (names), `check`, `check_routes` and
`records` (rows and files to problems), `read` (all of it). Writing: `template`, `lists`, `formulas`, `live_row`,
`writer`. Both go by `schema`, where every sheet and column stands once, and by `names`.
"""
