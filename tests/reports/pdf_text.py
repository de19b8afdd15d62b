"""The text of a PDF that Chromium made, page by page, as far as its own text layer has it."""

from __future__ import annotations

import base64
import re
import zlib
from unicodedata import normalize

_OBJECT = re.compile(rb"(?:^|\n)(\d+) 0 obj\r?\n?(.*?)endobj", re.DOTALL)
# A last \r belongs to the data.
_STREAM = re.compile(rb"stream\n(.*?)\nendstream", re.DOTALL)
_SHOWN = re.compile(
    rb"/(\S+) [\d.]+ Tf|<([0-9A-Fa-f]+)> ?Tj|\[(.*?)\] ?TJ|\((?:[^()\\]|\\.)*\) ?Tj", re.DOTALL
)
_HEX = re.compile(rb"<([0-9A-Fa-f]+)>")


def printed_pages(page) -> list[str]:
    """The page that is open, printed: the text of every sheet without its spaces.

    Spaces are left out: a PDF has places instead of them.
    """
    data = base64.b64decode(page.call("Page.printToPDF", printBackground=True)["data"])
    objects = {int(number): body for number, body in _OBJECT.findall(data)}
    return [_text_of(objects, body) for body in objects.values() if b"/Type /Page\n" in body]


def _stream(body: bytes) -> bytes:
    found = _STREAM.search(body)
    return b"" if found is None else zlib.decompress(found[1])


def _text_of(objects: dict[int, bytes], body: bytes) -> str:
    names = re.findall(rb"/(\S+) (\d+) 0 R", re.search(rb"/Font <<(.*?)>>", body, re.DOTALL)[1])
    fonts = {name: _letters(objects, objects[int(number)]) for name, number in names}
    contents = int(re.search(rb"/Contents (\d+) 0 R", body)[1])
    letters, found = {}, []
    for font, one, several in _SHOWN.findall(_stream(objects[contents])):
        letters = fonts[font] if font else letters
        for codes in [one] if one else _HEX.findall(several):
            found += [letters.get(codes[k : k + 4].upper(), "") for k in range(0, len(codes), 4)]
    # Letters that the font writes as one are letters again.
    text = re.sub("[\ufb00-\ufb06]", lambda sign: normalize("NFKC", sign[0]), "".join(found))
    return "".join(text.split())


def _letters(objects: dict[int, bytes], font: bytes) -> dict[bytes, str]:
    """By a glyph's code in hexadecimal, the letters that it stands for."""
    number = re.search(rb"/ToUnicode (\d+) 0 R", font)
    table = _stream(objects[int(number[1])]) if number else b""
    found = {}
    for part in re.findall(rb"beginbfchar(.*?)endbfchar", table, re.DOTALL):
        for code, text in re.findall(rb"<(\w+)> <(\w+)>", part):
            found[code.upper()] = bytes.fromhex(text.decode()).decode("utf-16-be")
    for part in re.findall(rb"beginbfrange(.*?)endbfrange", table, re.DOTALL):
        for first, last, text in re.findall(rb"<(\w+)> <(\w+)> <(\w+)>", part):
            for step in range(int(last, 16) - int(first, 16) + 1):
                found[b"%04X" % (int(first, 16) + step)] = chr(int(text, 16) + step)
    return found
