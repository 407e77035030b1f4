"""Many buildings: a folder or an index in, Parquet tables, a ranking, a page with a map and a summary out."""
