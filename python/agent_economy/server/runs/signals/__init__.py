"""Numbers of a run over time, sampled from the run itself."""
