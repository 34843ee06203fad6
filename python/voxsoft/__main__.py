"""``python -m voxsoft`` is ``voxsoft``, also where programs are not on the search path."""

from voxsoft.cli import main

if __name__ == "__main__":
    main()
