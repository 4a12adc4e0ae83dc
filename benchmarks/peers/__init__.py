"""The solver beside others on the same problems; see `benchmarks.peers.__main__`."""
