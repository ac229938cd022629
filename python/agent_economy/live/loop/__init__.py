"""The loop: makes percepts of lines, steps the brains at the pace of the clock, and records.

It is a child process of the warden, without sockets: see `agent_economy.live.warden`.
"""
