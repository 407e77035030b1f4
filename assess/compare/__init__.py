"""Two runs compared: two results.json read back, what changed between them, and the pages and tables that show it.

In: results.json of any origin. Out: a page (HTML, PDF), an Excel workbook, compare.json, lines for the terminal.
`past_run` turns a file of unknown origin into a `PastRun`; `changes` compares two of them and knows no file;
`comparison_document` says it in the language in use; `comparison_files` writes the files.
May import: the core. The export into building models reads results by `past_run`, too.
"""
