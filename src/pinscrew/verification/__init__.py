"""Do the engines agree? `run.verify` asks, `report.Report` tells."""
