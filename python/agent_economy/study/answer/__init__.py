"""The answer of a study, from its runs.

`evidence` says what the runs prove; `ties`, `front`, `saturation`, `sensitivity` and `effort` each
answer one question from it; `sentence` puts it in words; `conclude` gathers all.
"""
