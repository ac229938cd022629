"""The best configuration by the merits that a user's function, the sampler, returns.

The data flows one way: `select_best` -> `plan` (the question, and the sampler) -> `race` (the
loop: `selection` requests runs, `folder` reads or keeps them, `sampler` computes) -> `result`.
"""
