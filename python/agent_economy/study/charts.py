def specifications(*a): return {}
