"""Layer 3: engines, which answer the same questions about a robot independently of each other."""
