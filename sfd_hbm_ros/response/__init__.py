"""What an engineer asks of the solver: predictions, response curves, jumps."""
