"""The command `agent-economy`."""

import sys


def main() -> None:
    """Run the command line; Ctrl-C ends it without a traceback, even during imports."""
    try:
        if sys.argv[1:] == ["--version"]:
            print_version()
        else:
            run_command()
    except KeyboardInterrupt:
        sys.stderr.write("\nStopped.\n")
        sys.exit(130)
    except OSError as error:
        sys.stderr.write(f"agent-economy: {error}\n")
        sys.exit(1)


def print_version() -> None:
    """Print the version without loading the command line."""
    from agent_economy import __version__  # noqa: PLC0415

    sys.stdout.write(f"agent-economy {__version__}\n")


def run_command() -> None:
    """Load the command line and run it."""
    import io  # noqa: PLC0415

    from agent_economy.cli import app  # noqa: PLC0415  (slow: Ctrl-C must be caught in it)

    for stream in (sys.stdout, sys.stderr):
        # Characters that the terminal's encoding lacks are escaped.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    app()


if __name__ == "__main__":
    main()
