"""``omegadot`` and ``python -m omegadot``: Ctrl-C is met from the first import on."""

import sys


def main() -> None:
    """Entry point: run the command line; interrupted as it is loaded, print that and no more."""
    try:
        from omegadot.commands.cli import main as run_command
    except KeyboardInterrupt:
        print("omegadot: interrupted.", file=sys.stderr)
        sys.exit(130)  # 128 + SIGINT, as shells count
    run_command()


if __name__ == "__main__":
    main()
