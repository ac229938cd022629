"""The answer of a study, from its runs.

`evidence` computes what the runs prove; `ties`, `front`, `saturation`, `sensitivity` and `effort`
each answer one question from it; `sentence` puts the answer into words; `best` and
`requirement` are the answers to the two questions, which `study.questions` conclude.
"""
