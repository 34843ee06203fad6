"""``python -m voxsoft`` is ``voxsoft``, also where the folder of programs is not on the search path."""

from voxsoft.cli import main

if __name__ == "__main__":
    main()
