"""The answer of a study, from its runs.

`evidence` computes what the runs prove; `ties`, `front`, `saturation`, `sensitivity` and `effort`
each answer one question from it; `sentence` puts the answer into words; `conclude` combines all.
"""
