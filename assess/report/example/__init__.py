"""One piece worked through: every method with its numbers put in."""
