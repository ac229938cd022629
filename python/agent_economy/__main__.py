"""The command `agent-economy`."""

import sys

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


def main() -> None:
    """Run the command line; Ctrl-C ends it without a traceback, even while modules load."""
    try:
        from agent_economy.cli import app  # noqa: PLC0415  (slow: Ctrl-C must be caught in it)

        app()
    except KeyboardInterrupt:
        sys.stderr.write("\nStopped.\n")
        sys.exit(INTERRUPTED)


if __name__ == "__main__":
    main()
