"""A record in the terminal and in Markdown."""
