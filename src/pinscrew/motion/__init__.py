"""Layer 4: motion over time: rates in, poses out, and rates back from velocities."""
