"""Many buildings under one earthquake. It stands alone: nothing of the core imports it.

In: a folder or an index of workbooks and COBie files, a ShakeMap or fields of ground motion.
Out: Parquet tables (`table_schemas`), a ranking (Excel), a page with a map (HTML, PDF) and a summary of the city.
Way: `sources` (which buildings), `building_task` (one building, in a worker: `local_pool` or `cluster`),
`city_tables` and `city` (what falls together), `city_page` and `ranking_workbook` (what is shown). A run that was
stopped goes on.
May import: the core, `compare`, and `bim` where a building is a COBie file. Needs: the extra `parquet`.
"""
