"""`python -m pirsim`: the command, where it isn't on the path."""

from _pirsim_command import main

main()
