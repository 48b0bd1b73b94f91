"""What every layer stands on and no robot knows: errors, words, numbers, files, memory, processes."""
