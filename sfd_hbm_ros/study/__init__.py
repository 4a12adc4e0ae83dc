"""Many variants of one machine: grids and Monte Carlo over entries of its file."""
