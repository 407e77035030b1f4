"""One rigid block: its geometry."""
