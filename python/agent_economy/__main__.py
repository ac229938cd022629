"""The command `agent-economy`."""

import io
import sys


def main() -> None:
    """Run the command line; Ctrl-C ends it without a traceback, even while modules load."""
    try:
        from agent_economy.cli import app  # noqa: PLC0415  (slow: Ctrl-C must be caught in it)

        for stream in (sys.stdout, sys.stderr):
            # What the terminal's encoding lacks is shown as its code.
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")
        app()
    except KeyboardInterrupt:
        sys.stderr.write("\nStopped.\n")
        sys.exit(130)
    except OSError as error:
        sys.stderr.write(f"agent-economy: {error}\n")
        sys.exit(1)


if __name__ == "__main__":
    main()
