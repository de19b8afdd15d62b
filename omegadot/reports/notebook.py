"""A page inside a notebook's cell."""

from __future__ import annotations

from html import escape

LARGEST_PAGE = 10_000_000  # characters; every cell that shows it stores them in the notebook
HEIGHT = 900  # CSS pixels: the headline and the charts below it

# Where a page stands in a frame, "#part" would lead to a part of the notebook.
OWN_BASE = '<base href="about:srcdoc">'


def framed(page: str, alternative: str, height: int = HEIGHT) -> str:
    """A frame with a whole page in it, for a notebook to show.

    The page stands in the frame's own attribute, so that a stored notebook keeps it and no server
    is needed; ``sandbox`` lets its script draw and keeps it from the notebook.
    alternative: a sentence in place of a page that is too large to store in a cell.
    """
    if len(page) > LARGEST_PAGE:
        size = f"{len(page) / 1e6:.0f} MB"
        return (
            f"<p>{escape(alternative)} The page takes {size}, too much for a notebook's cell; "
            "write it with .save(FOLDER) and open it there.</p>"
        )
    own = page.replace("<head>", f"<head>{OWN_BASE}", 1)
    text = own.replace("&", "&amp;").replace('"', "&quot;")
    frame = (
        f'<iframe srcdoc="{text}" sandbox="allow-scripts allow-downloads" '
        f'title="{escape(alternative)}" loading="lazy" '
        f'style="width: 100%; height: {height}px; border: 0"></iframe>'
    )
    # ASCII alone: where the page around it names no encoding, the browser guesses one.
    return frame.encode("ascii", "xmlcharrefreplace").decode()
