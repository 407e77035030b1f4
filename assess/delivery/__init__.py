"""Files that appear whole or not at all: where results are written, and how they come to their place.

Files are first written, and brought to the disk, in a folder of their own (`stages`). They come to their place in one
of two ways:

* *exchange* (`exchange`): a folder that holds nothing but files of an earlier run is exchanged for the new one by one
  call of the system (Linux, macOS). Whoever looks sees all files of one run, whenever the process is killed.
* *journal* (`moves`): elsewhere (other files in the folder, a process that stands in it, Windows, a file system or a
  mount point that cannot exchange) the files are moved one by one. Before the first move the old files are kept beside
  and a journal is written; a move that fails is taken back at once, and one that was killed is finished by the next run
  into the folder. Between the first move and the last, some tens of microseconds each, an observer may see files of two
  runs, and the journal.

A lock on the folder (`folder_lock`) keeps two processes from moving files into it at once; the system releases it when
a process dies. `traces` knows what this process has put on the disk for a time, so that a signal leaves none of it.
Not guaranteed: that a file system keeps what it reported as written to the disk.
"""
