"""Ground and floor motion: what a recording holds, and what the rest of the program makes of it."""
