"""What an edit to a robot's description changed, as an engineer says it."""
