"""Who runs it: one engine a file, behind one small protocol."""
