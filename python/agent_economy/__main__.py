"""The command `agent-economy`."""

import sys


def main() -> None:
    """Run the command line; Ctrl-C ends it without a traceback, even during imports."""
    try:
        escape_characters()
        if sys.argv[1:] == ["--version"]:
            print_version()
        elif sys.argv[1:2] == ["stop"]:
            stop()
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
    from agent_economy.build import version_line  # noqa: PLC0415

    sys.stdout.write(f"{version_line()}\n")


def stop() -> None:
    """Stop the drives without loading the command line, which takes longer than the stop."""
    from agent_economy.live.discovery.stopping import options_of, stop_drives  # noqa: PLC0415

    options = options_of(sys.argv[2:])
    if options is None:  # Help, or a mistake.
        run_command()
    else:
        process, as_json = options
        report = stop_drives(process, print_line, as_json=as_json)
        for line in report.errors:
            print_line(line, is_error=True)
        sys.exit(report.exit_code)


def print_line(line: str, *, is_error: bool = False) -> None:
    """Print a line at once."""
    stream = sys.stderr if is_error else sys.stdout
    if stream is not None:  # closed by the parent
        stream.write(f"{line}\n")
        stream.flush()


def run_command() -> None:
    """Load the command line and run it."""
    from agent_economy.cli import app  # noqa: PLC0415  (slow: Ctrl-C must be caught in it)

    app()


def escape_characters() -> None:
    """Escape characters that the terminal's encoding lacks."""
    import io  # noqa: PLC0415

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


if __name__ == "__main__":
    main()
