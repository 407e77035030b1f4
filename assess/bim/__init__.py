"""Building models and handover files in, workbooks out, and results back. It stands alone: the core never imports it.

In: IFC, RoomPlan, Sweet Home 3D and COBie files; a workbook to bring up to date; results.json.
Out: an inventory workbook with plans and drafts of routes; an updated workbook and a list of changes; an IFC with
risk classes, and BCF topics of what to fix.
Way: each reader yields a `building_model.BuildingModel` (`ifc_model`, `roomplan`, `sweet_home`; `cobie` rows of its
own); `model_rows` makes rows of it, `draft_routes` routes, `import_workbook` the workbook; `update_workbook` goes
through `assess.workbook.store`; `export_files` writes results back. Readers run in a process with limits
(`model_process`).
May import: the core. Needs: the extra `ifc` for IFC alone.
"""
