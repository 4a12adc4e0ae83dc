"""The process that computes response curves while the predictor answers."""
