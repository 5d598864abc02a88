"""The command line, as `python -m fetch_pomdp`."""

from fetch_pomdp.cli.main import main

main()
