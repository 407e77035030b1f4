"""The figures of a report, and what stands below them."""
