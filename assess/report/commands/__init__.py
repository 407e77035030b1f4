"""What the commands record and rock print and draw, and the figure of an ensemble."""
