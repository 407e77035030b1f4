"""Two runs compared: two results.json read back, what changed between them, and the pages and tables that show it.

`past_run` turns a file of unknown origin into a `PastRun`; `changes` compares two of them and knows no file;
`comparison_document` says it in the language in use; `comparison_files` writes the files.
"""
