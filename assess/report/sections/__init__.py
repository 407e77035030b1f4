"""The sections of a report: the `PARTS` of each file are found here, and say in which editions they stand where."""
