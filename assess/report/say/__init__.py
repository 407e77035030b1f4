"""What is said of a subject, once for every output: pieces, the ground, the simulation, routes, work."""
