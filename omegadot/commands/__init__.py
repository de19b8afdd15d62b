"""The commands' words: one signature a file, its work imported only when it is called."""
