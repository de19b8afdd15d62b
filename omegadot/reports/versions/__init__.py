"""Several versions of an engine: sheet, chart, page and files."""
