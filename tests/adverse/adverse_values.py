"""What may stand where an option or argument wants a number, a name, a file or a folder.

Each value has a short name, by which a failing case is found again.
"""

from __future__ import annotations

import os
from pathlib import Path

# What a kind of option is called in the help, and which of the values below it may meet.
NUMBERS = {"S", "A", "GIB", "N", "INTEGER", "HZ", "X", "KG", "T", "RATIO"}
QUANTITIES = {"ANGLE", "RATE", "TIME", "0.1deg", "1e-3deg/s", "1mm", "1e-6", "1ms"}
VECTORS = {"X,Y,Z", "x,-y,-z"}
ROWS = {"X Y Z": 3, "W X Y Z": 4}
FILES = {"FILE", "TRACE", "SCENARIO", "[SCENARIO]...", "EARLIER", "LATER", "RUN [RUN]"}
PAIRS = {"ROLE=NAME", "NAME=PATH", "WHICH=VALUE"}
CODE = {"FILE.py:CLASS", "FILE#LINK"}
FOLDERS = {"DIR", "FILE.toml"}

NUMBER_VALUES = {
    "nan": "nan",
    "infinite": "inf",
    "negative-infinite": "-inf",
    "zero": "0",
    "negative": "-3",
    "huge": "1e300",
    "beyond-double": "1e999",
    "tiny": "1e-300",
    "many-digits": "9" * 5000,
    "hexadecimal": "0x10",
    "half": "0.5",
    "empty": "",
    "blank": " ",
    "a-word": "soon",
    "decimal-comma": "1,5",
    "arabic-digit": "\u0663",
    "two-numbers": "1 2",
}
NAME_VALUES = {
    "empty": "",
    "blank": "  ",
    "long": "x" * 5000,
    "escape": "\x1b[31mred\x07",
    "newline": "two\nlines",
    "null": "a\0b",
    "surrogate": "caf\udce9",
    "right-to-left": "\u202eabc",
    "up": "../../x",
    "option": "--nope",
    "colons": ":::",
    "equals": "==",
    "number": "12",
}
VECTOR_VALUES = {
    "empty": "",
    "one": "1",
    "two": "1,2",
    "four": "1,2,3,4",
    "nan": "nan,0,0",
    "infinite": "0,inf,0",
    "words": "x,y,w",
    "same-axis-twice": "x,x,z",
    "left-handed": "x,y,-z",
    "huge": "1e300,1e300,1e300",
    "commas": ",,",
    "blanks": "1 2 3",
}
PAIR_VALUES = {**NAME_VALUES, "no-right": "w=", "no-left": "=wx", "twice": "w=wx=wy"}
CODE_VALUES = {
    "empty": "",
    "colons": ":::",
    "long": "x" * 5000,
    "null": "a\0b:Toy",
    "escape": "\x1b[31mred\x07:Toy",
    "missing-file": "nowhere.py:Class",
    "missing-class": "toy.py:Nowhere",
    "not-a-class": "toy.py:json",
    "raises": "raises.py:Toy",
    "syntax": "syntax.py:Toy",
    "exits": "exits.py:Toy",
    "not-python": "binary:Toy",
    "module": "os:path",
    "no-link": "nowhere.urdf#base",
    "broken-xml": "broken.urdf#base",
    "deep-xml": "deep.urdf#base",
}


def adverse_files(folder: Path) -> None:
    """Make in `folder` every file, and thing that is none, which a command may be pointed to."""
    (folder / "empty").touch()
    (folder / "binary").write_bytes(bytes(range(256)) * 64)
    (folder / "latin1").write_bytes("name = 'caf\u00e9'\nt,wx,wy,wz\n0,1,2,3".encode("latin-1"))
    (folder / "utf16").write_text("schema = 1\nt,wx,wy,wz\n", encoding="utf-16")
    (folder / "bom").write_text("\ufeff", encoding="utf-8")
    (folder / "nulls").write_bytes(b"\0" * 1000)
    (folder / "one-line").write_text("1," * 200_000)
    (folder / "deep").write_text("a = " + "[" * 50_000 + "]" * 50_000)
    (folder / "keys").write_text("".join(f"[a{n}]\n" for n in range(20_000)))
    (folder / "text").write_text("It was a dark and stormy night.\n")
    (folder / "json").write_text('{"schema": 1, "tasks": null}')
    (folder / "parquet").write_bytes(b"PAR1" + b"\0" * 100 + b"PAR1")
    (folder / "toml").write_text("schema = 99\n[body]\nmass = 'heavy'\n")
    (folder / "a-folder").mkdir()
    (folder / "record-of-nothing").mkdir()
    (folder / "record-of-nothing" / "run.json").write_text("{}")
    os.mkfifo(folder / "fifo")
    (folder / "loop").symlink_to("loop")
    (folder / "dangling").symlink_to("nowhere")
    (folder / "raises.py").write_text("raise ValueError('as it is imported')\n")
    (folder / "exits.py").write_text("import os\nos._exit(7)\n")
    (folder / "syntax.py").write_text("def (:\n")
    (folder / "toy.py").write_text("import json\n\n\nclass Toy:\n    pass\n")
    (folder / "broken.urdf").write_text("<robot><link name='base'>")
    (folder / "deep.urdf").write_text("<a>" * 20_000 + "</a>" * 20_000)


TOO_LONG = "x" * 300
NO_FILES = {"loop", "fifo", "/dev/zero", "text/x", "a-folder"}  # neither to read nor to replace
FILE_VALUES = [
    *("empty", "binary", "latin1", "utf16", "bom", "nulls", "one-line", "deep", "keys", "text"),
    *("json", "parquet", "toml", "a-folder", "record-of-nothing", "fifo", "loop", "dangling"),
    *("nowhere", "/dev/zero", "/dev/null", "/dev/full", "/proc/self/mem", TOO_LONG, "text/x"),
]
FOLDER_VALUES = [
    *("text", "fifo", "loop", "a-folder/text/x", "text/x", "/dev/null", "/dev/null/x", "/proc/x"),
    *(TOO_LONG, "/", "..", "dangling/x", "", "\0", "/sys/x"),
]
