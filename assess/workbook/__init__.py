"""The workbook: its bytes to the inventory that it holds, and back.

In: the bytes of an .xlsx, or rows given in code; the records, plans, photos and the logo that it names.
Out: `assess.model.Inventory`, and every problem by sheet and cell; a new workbook; the bytes of a changed one.
Reading: `open` (bytes to cells), `parse` (cells to typed rows), `values` (what one cell means), `resolve` (names),
`check` and `check_routes` (rows to problems), `records` and `picture_files` (files), `read` (all of it).
Changing: `store` holds the cells and writes them back by `patch` and `row_shift`, and leaves every other byte.
Writing: `template`, with the live formulas of `lists`, `live_row` and `formulas`. `schema` has each sheet and column
once.
May import: `model`, `plans`, `motion`, `results`, `fields` and what stands below. Knows no report and no physics.
"""
