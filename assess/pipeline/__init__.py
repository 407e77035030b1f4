"""Run the work: an inventory in, an assessment out."""
