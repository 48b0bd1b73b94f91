"""Layer 4: do the engines agree? `run.verify` asks, `report.Report` tells."""
