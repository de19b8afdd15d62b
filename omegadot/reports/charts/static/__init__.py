"""The charts of a run as pictures for papers and slides: SVG and PNG."""
