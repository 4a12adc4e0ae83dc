"""What the demo prints of a run, from what the predictor publishes."""
