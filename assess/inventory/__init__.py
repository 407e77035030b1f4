"""The workbook and the inventory that it holds."""
