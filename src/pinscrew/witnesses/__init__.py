"""Other people's engines, to hold ours against."""
