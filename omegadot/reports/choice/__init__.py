"""A choice of engine: sentences, tables, chart, page and files."""
