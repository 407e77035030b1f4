"""Building models and handover files in, workbooks out."""
