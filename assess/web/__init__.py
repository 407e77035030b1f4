"""The page: the workbook as sheets and as a plan in the browser, and the server behind it. It stands alone.

In: a workbook on the disk or sent by a browser; edits of its cells; files that it names.
Out: JSON for the page (`endpoints`), the workbook with its edits, reports by a process of its own (`jobs`).
Way: `server` starts, `guard` checks each request, `sessions` keeps one `book.Book` a user, which is the workbook of
`assess.workbook.store` with a history; `snapshot` is one version of it, `evaluation` and `live` what the core says of
it. The browser's side is in `page/`; docs/page.md describes both.
May import: the core, and `bim` where a building model is sent. Needs: the extra `web`.
"""
