"""The verbs of the command line, one a file: `add_options` and `run`."""
