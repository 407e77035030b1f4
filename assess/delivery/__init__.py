"""Files that appear whole or not at all: where results are written, and how they come to their place.

Files are first written, and brought to the disk, in a folder of their own (a stage, see `folders`), and then moved to
their place one by one, each by one call of the system. A set of files with a list of them, such as results.json, is
whole if that list is there: it is set aside before the first file is moved, and the new one comes last. A folder
without it is unfinished (`is_unfinished`): every reader says so, and the next run into it, which knows the files of
both runs by what was set aside, completes it. There are never files of two runs with one list.

A move that fails is taken back at once. A lock on the folder keeps two processes from moving files into it at once.
What this process has put on the disk for a time is known, so that a signal leaves none of it. Not guaranteed:
that a file system keeps what it reported as written to the disk.
"""
