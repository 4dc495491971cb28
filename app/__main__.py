"""`python -m linkwright.app` is `linkwright`."""

from .cli import main

if __name__ == "__main__":
    main()
