"""Layer 4: where a frame can get, and how well it moves there."""
