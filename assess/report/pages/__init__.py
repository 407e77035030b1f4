"""The report as a page: HTML from the templates, and the PDF from that."""
