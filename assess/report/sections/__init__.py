"""The sections of a report, one a file: each is found here, and says in which editions it stands and where."""
