"""The command line: one file a command, found by its name.

In: arguments. Out: lines on the terminal, files where the user names them, an exit status.
A `command_NAME.py` defines `command`, `EXAMPLES` and `ORDER`; `options` declares what several share, `console` prints
progress, problems and what was written, `interrupts` ends a command that a signal stops.
May import: everything, and late: `assess --help` loads no physics. Only this package names options.
"""
