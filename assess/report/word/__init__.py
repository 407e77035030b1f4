"""The Word edition of the report."""
