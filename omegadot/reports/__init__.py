"""What is shown: the record's format, the summary, the terminal's table, the HTML page.

This room reads records alone, so that a page can be drawn again from a stored run.
"""
