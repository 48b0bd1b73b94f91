"""Layer 5: the arm, its screws and its velocities to look at, in a page of meshcat."""
