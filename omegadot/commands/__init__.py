"""What people type and call: one folder a command.

``command.py`` holds the arguments as they are typed, ``X.py`` the typed function that scripts call,
``print_X.py`` what is printed, where it is long. What a command does is imported when it is called.
"""
