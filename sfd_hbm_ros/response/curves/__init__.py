"""Response curves: their branches, the jumps on them and a walk along them."""
