"""``omegadot`` and ``python -m omegadot``: signals are met from the first import on."""

import sys

from omegadot.commands.signals import code_of, end_like_ctrl_c


def main() -> None:
    """Entry point: run the command line; interrupted as it is loaded, print that and no more."""
    received = end_like_ctrl_c()
    try:
        from omegadot.commands.cli import main as run_command
    except KeyboardInterrupt:
        print("omegadot: interrupted.", file=sys.stderr)
        sys.exit(code_of(received))
    run_command(received)


if __name__ == "__main__":
    main()
