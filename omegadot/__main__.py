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
    except EOFError as error:  # of a module's bytecode that is cut off
        advice = "a compiled module is cut off; remove the __pycache__ folders and try again"
        print(f"omegadot: could not be started: EOFError: {error}; {advice}.", file=sys.stderr)
        sys.exit(3)
    run_command(received)


if __name__ == "__main__":
    main()
