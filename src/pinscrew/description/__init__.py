"""Layer 1: what files say about robots. No kinematics."""
