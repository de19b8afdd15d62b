"""The command line of a program that serves an engine, ``node worker.js`` or ``NAME=./worker``."""

from __future__ import annotations

import os
import re
import shlex
import shutil
from pathlib import Path

from omegadot.adapters.registry import AdapterError

NAME = re.compile(r"[A-Za-z][\w.+-]{0,59}", re.ASCII)
"""What the name of an engine of one's own may be, see `NAME_RULE`."""
NAME_RULE = "at most 60 letters, digits, '-', '_', '+' and '.', a letter first"
_QUOTED = re.compile(r"""\\.|'[^']*'|"(?:\\.|[^"\\])*\"""", re.DOTALL)
_OPERATOR = re.compile(r"[|&<>;]+")
_SUFFIX = re.compile(r"(?<=.)\.[A-Za-z]\w*$")


def program_of(command: str) -> list[str]:
    """The words of a command line without the engine's name, its program found.

    Raises AdapterError where there is no such program, where the name is none, and where a word
    would mean something to a shell alone.
    """
    name, words = _parts(command)
    operator = _OPERATOR.search(_QUOTED.sub("", command))
    if operator:
        raise AdapterError(
            f"{command}: {operator[0]} is a shell's, and the program is started without one; put "
            f"the line into a script, or {operator[0]} into quotes where it is an argument."
        )
    program = shutil.which(words[0])
    if program is None:
        raise AdapterError(f"{command}: {_not_found(words[0])}{_variable(name, command)}.")
    return [program, *words[1:]]


def name_in_command(command: str) -> str:
    """The engine's name in ``NAME=PROGRAM ...``, "" without one. Raises AdapterError."""
    return _parts(command)[0]


def file_in_command(command: str) -> Path:
    """The last word that is a file; else the last that looks like one; else the program.

    Raises AdapterError.
    """
    _, words = _parts(command)
    arguments = [word for word in words[1:] if not word.startswith("-")]
    there = [word for word in arguments if os.path.isfile(word)]
    alike = [word for word in arguments if _looks_like_a_file(word)]
    return Path((there or alike or words[:1])[-1])


def own_name_of(command: str) -> str:
    """The name that a program's engine has without ``NAME=``: that of its file, without a suffix,
    in small letters; it may be none that `NAME` allows.
    """
    stem = _SUFFIX.sub("", file_in_command(command).name)
    return re.sub(r"[^\w-]+", "-", stem, flags=re.ASCII).strip("-").lower()


def _parts(command: str) -> tuple[str, list[str]]:
    """The engine's name, "" without one, and the words after it."""
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise AdapterError(f"{command}: {error}; correct the quotes.") from None
    name, sign, program = words[0].partition("=") if words else ("", "", "")
    if not sign or has_folder(name) or shutil.which(words[0]):
        name = ""
    elif not NAME.fullmatch(name):
        hint = _variable(name, command)
        raise AdapterError(f"{command}: {name!r} is no name; give {NAME_RULE}{hint}.")
    else:
        words = [*filter(None, [program]), *words[1:]]
    if not words:
        raise AdapterError(f"{command}: no program is named; give one, with its arguments.")
    return name, words


def has_folder(word: str) -> bool:
    """Whether a word names a file by its folder, as ``./worker`` does."""
    return os.sep in word or bool(os.altsep and os.altsep in word)


def _looks_like_a_file(word: str) -> bool:
    return not re.search(r"\s", word) and (has_folder(word) or bool(_SUFFIX.search(word)))


def _not_found(program: str) -> str:
    if not os.path.isfile(program):
        return f"there is no program {program}; install it or check its path"
    if not has_folder(program) and os.access(program, os.X_OK):
        return f"there is no program {program} on the path; write ./{program} for the file"
    return (
        f"{program} is a file that cannot be started; make it executable (chmod +x), or write the "
        f"program that runs it before it, as in node {program}"
    )


def _variable(name: str, command: str) -> str:
    """Advice where NAME=VALUE may be a variable of the environment."""
    if not name.isupper():
        return ""
    return f", or write env {command} if {name} is a variable of the environment"
