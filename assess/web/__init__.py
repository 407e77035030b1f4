"""The page: the workbook as sheets and as a plan in the browser, and the server behind it."""
